// SPDX-License-Identifier: Apache-2.0
// Reads a lenticular device's own calibration file (visual.json), and says what is wrong with one.

const kBytesMax = 64 << 10;
const kSideMax_px = 16384;
const kOffsetMax_px = 16;
const kCellCountMax = 4;
// Lenses that lie flatter than this have no width along a row.
const kSlopeMin = 0.01;
const kSlopeMax = 1e6;
const kShownMax = 40;

function refuse(key, problem) {
  return new Error(
      `${key}: ${problem}; copy LKG_calibration/visual.json from the device once more`);
}

// The value that came, short enough for a sentence.
function describe(value) {
  const text = JSON.stringify(value);
  return text.length > kShownMax ? `${text.slice(0, kShownMax)}...` : text;
}

// Numbers stand plain or as {"value": x}.
function valueAt(object, key) {
  const found = object[key];
  return typeof found === 'object' && found !== null && 'value' in found ? found.value : found;
}

// fallback: where the key is absent; undefined = it must be there.
function number(object, key, min, max, fallback) {
  const value = valueAt(object, key);
  if (value === undefined && fallback !== undefined) return fallback;
  const accepted = `accepted is a number ${min}..${max}, plain or as {"value": x}`;
  if (value === undefined) throw refuse(key, `is missing; ${accepted}`);
  if (typeof value !== 'number' || !(value >= min && value <= max)) {
    throw refuse(key, `is ${describe(value)}; ${accepted}`);
  }
  return value;
}

function whole(object, key, min, max, fallback) {
  const value = number(object, key, min, max, fallback);
  if (Number.isInteger(value)) return value;
  throw refuse(key, `is ${value}; accepted is a whole number ${min}..${max}`);
}

// On from a half, as players of the device read it.
function flag(object, key, fallback) {
  return number(object, key, -1e6, 1e6, fallback ? 1 : 0) >= 0.5;
}

// One cell: offsets of red, green and blue from the centre of the px, px to the right and upwards.
function readCell(object, index) {
  const place = `subpixelCells[${index}]`;
  if (typeof object !== 'object' || object === null) {
    throw refuse(place, `is ${describe(object)}; accepted is an object with ROffsetX .. BOffsetY`);
  }
  const offset = (name) => number(object, name, -kOffsetMax_px, kOffsetMax_px);
  try {
    return ['R', 'G', 'B'].map(
        (channel) => ({x_px: offset(`${channel}OffsetX`), y_px: offset(`${channel}OffsetY`)}));
  } catch (error) {
    throw new Error(`${place}.${error.message}`);
  }
}

function readCells(object) {
  const cells = object.subpixelCells ?? [];
  if (!Array.isArray(cells) || cells.length > kCellCountMax) {
    throw refuse('subpixelCells', `is ${describe(cells)}; accepted is a list of up to ` +
                     `${kCellCountMax} cells: no pattern has more`);
  }
  return cells.map(readCell);
}

// Lenses across the panel's width, along a row; negative where the pitch is.
export function lensCount({pitch, slope, dpi, screen_px}) {
  return pitch * screen_px.width / dpi * Math.cos(Math.atan(1 / slope));
}

function checkLenses(calibration) {
  const {pitch, slope, screen_px} = calibration;
  if (pitch === 0) throw refuse('pitch', 'is 0; accepted is a number other than 0, as 52.6');
  if (Math.abs(slope) < kSlopeMin) {
    throw refuse('slope', `is ${slope}; accepted is a number of ${kSlopeMin}..${kSlopeMax} in ` +
                     'size, as -7.2');
  }
  const lenses = Math.abs(lensCount(calibration));
  if (lenses <= screen_px.width) return;
  throw refuse('pitch', `is ${pitch}, which makes ${lenses.toFixed(0)} lenses across ` +
                   `${screen_px.width} px; accepted is up to one a px`);
}

function parseObject(text) {
  if (text.length > kBytesMax) {
    throw refuse('calibration', `has ${text.length} characters; accepted are up to ${kBytesMax}`);
  }
  let value;
  try {
    value = JSON.parse(text);
    if (typeof value === 'string') value = JSON.parse(value);  // as Bridge hands it on
  } catch (error) {
    throw refuse('calibration', `is no JSON: ${error.message}`);
  }
  if (typeof value === 'object' && value !== null && !Array.isArray(value)) return value;
  throw refuse('calibration', `is ${describe(value)}; accepted is one JSON object with pitch, ` +
                   'slope, center, DPI, screenW and screenH');
}

// text: the file, in every spelling that devices and tools write. Throws an Error whose message is
// one sentence that names the key.
export function parseCalibration(text) {
  const object = parseObject(text);
  const mode = 'CellPatternMode' in object ? 'CellPatternMode' : 'cellPatternMode';
  const calibration = {
    pitch: number(object, 'pitch', -1e4, 1e4),  // lenses per inch, across them
    slope: number(object, 'slope', -kSlopeMax, kSlopeMax),
    center: number(object, 'center', -1e4, 1e4),
    view_cone_deg: number(object, 'viewCone', 1, 179, 40),
    dpi: number(object, 'DPI', 1, 1e5),
    screen_px: {
      width: whole(object, 'screenW', 1, kSideMax_px),
      height: whole(object, 'screenH', 1, kSideMax_px),
    },
    inv_view: flag(object, 'invView', true),
    flip_x: flag(object, 'flipImageX', false),
    flip_subpixels: flag(object, 'flipSubp', false),
    cell_pattern_mode: whole(object, mode, 0, 4, 0),
    cells: readCells(object),
    serial: String(valueAt(object, 'serial') ?? '').slice(0, 100),
  };
  checkLenses(calibration);
  return calibration;
}
