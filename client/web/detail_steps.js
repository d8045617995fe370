// SPDX-License-Identifier: Apache-2.0
// The steps of automatic detail, from the most to the least: {views, detail}. Detail is a share of
// a view's width and height.

// Each halves the number of px.
const kDetails = [1, 0.7, 0.5, 0.35, 0.25, 0.18, 0.125];
// A view that is looked at is never narrower, px.
const kLeastWidth = 200;

// All views of a quilt count as one: their number stays.
export const kQuiltSteps = kDetails.map((detail) => ({views: 1, detail}));

// Views around the eye: fewer come before coarser ones. counts: of views, from the most to the
// least; width: of a view in full detail, px
export function eyeSteps(counts, width) {
  const coarser = kDetails.slice(1).filter((detail) => detail * width >= kLeastWidth);
  return [...counts.map((views) => ({views, detail: 1})),
    ...coarser.map((detail) => ({views: counts.at(-1), detail}))];
}
