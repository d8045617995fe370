// SPDX-License-Identifier: Apache-2.0
// Lenses to look through without a device: calibrations of real units, as owners published them.

const kPortrait = {
  serial: 'LKG-PORT-02283', pitch: 52.563010659943416, slope: -7.244674277559994,
  center: 0.4016996953176948, viewCone: 40, DPI: 324, screenW: 1536, screenH: 2048,
};
const kThirdGeneration = {
  serial: 'LKG-J00332', pitch: 44.75058319896644, slope: -6.874565686767793,
  center: 0.16935753461833172, viewCone: 50, DPI: 283, screenW: 3840, screenH: 2160,
  CellPatternMode: 2,
  subpixelCells: [
    {ROffsetX: -0.31, ROffsetY: 0.25, GOffsetX: 0.28, GOffsetY: 0.25, BOffsetX: 0,
     BOffsetY: -0.25},
    {ROffsetX: -0.31, ROffsetY: -0.25, GOffsetX: 0.28, GOffsetY: -0.25, BOffsetX: 0,
     BOffsetY: 0.25},
  ],
};
const kFirstGeneration = {
  serial: '00297', pitch: 49.81804275512695, slope: 5.044347763061523,
  center: 0.176902174949646, viewCone: 40, DPI: 338, screenW: 2560, screenH: 1600,
};

// Name for a list, and the file.
export const kSamplePanels = [
  ['Portrait', kPortrait],
  ['16" gen3 landscape', kThirdGeneration],
  ['8.9" gen1', kFirstGeneration],
].map(([name, file]) => ({name, text: JSON.stringify(file)}));
