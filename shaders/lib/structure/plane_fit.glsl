// SPDX-License-Identifier: Apache-2.0
// Least-squares planes over a regular grid of samples, some of which may be missing at the image
// border.
#ifndef VIEWLOOM_LIB_STRUCTURE_PLANE_FIT_GLSL_
#define VIEWLOOM_LIB_STRUCTURE_PLANE_FIT_GLSL_

// Sums over the samples that exist. They form a rectangle (a border cuts whole rows and columns),
// so the two axes are independent: slope = sum((x - mean x) w) / sum((x - mean x)^2).
struct PlaneFit {
  float count;
  vec2 position;    // sum of positions, px from the block's centre
  vec2 square;      // sum of squared positions
  float inv_z;      // sum
  vec2 moment;      // sum of position * inv_z
  vec2 slope;       // sum of the samples' own slopes: used along an axis with one sample
};

PlaneFit startFit() {
  return PlaneFit(0.0, vec2(0.0), vec2(0.0), 0.0, vec2(0.0), vec2(0.0));
}

void addSample(inout PlaneFit fit, vec2 position, float inv_z, vec2 slope) {
  fit.count += 1.0;
  fit.position += position;
  fit.square += position * position;
  fit.inv_z += inv_z;
  fit.moment += position * inv_z;
  fit.slope += slope;
}

vec2 fittedSlope(PlaneFit fit) {
  const vec2 spread = fit.square - fit.position * fit.position / fit.count;
  const vec2 lean = fit.moment - fit.position * (fit.inv_z / fit.count);
  return vec2(spread.x > 0.1 ? lean.x / spread.x : fit.slope.x / fit.count,
              spread.y > 0.1 ? lean.y / spread.y : fit.slope.y / fit.count);
}

// At the block's centre.
float fittedCenter(PlaneFit fit, vec2 slope) {
  return (fit.inv_z - dot(slope, fit.position)) / fit.count;
}

#endif  // VIEWLOOM_LIB_STRUCTURE_PLANE_FIT_GLSL_
