// SPDX-License-Identifier: Apache-2.0
// The steps of automatic detail, from the most to the least: shares of a view's width and height.

// Each halves the number of px.
export const kQuiltSteps = [1, 0.7, 0.5, 0.35, 0.25, 0.18, 0.125];
