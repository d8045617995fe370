// SPDX-License-Identifier: Apache-2.0
#include "display/ray_samples.h"

#include <array>
#include <cmath>

#include <glm/vec3.hpp>

namespace viewloom {
namespace {

constexpr int kAxisCount = 4;  // px right, px down, eye right, eye up

// The positive root of x^5 = x + 1: R4 steps by its negative powers.
constexpr double kRoot = 1.1673039782614187;

// In [-0.5, 0.5); the first is 0.
double spread(uint32_t index, int axis) {
  const double position = 0.5 + index * std::pow(kRoot, -(axis + 1));
  return position - std::floor(position) - 0.5;
}

}  // namespace

std::vector<RaySample> filterSamples(const RayFilter& filter, glm::dvec2 pitch_m) {
  std::vector<RaySample> samples;
  for (uint32_t index = 0; index < filter.sample_count; ++index) {
    std::array<double, kAxisCount> at;
    for (int axis = 0; axis < kAxisCount; ++axis) at[size_t(axis)] = spread(index, axis);
    samples.push_back(
        {.px = {at[0], at[1]}, .eye_m = glm::dvec2(at[2], at[3]) * pitch_m * filter.width});
  }
  return samples;
}

std::vector<RaySample> channelSamples(const RayFilter& filter, glm::dvec2 pitch_m) {
  std::vector<RaySample> samples;
  for (const uint8_t channel : {kGreenChannel, kRedChannel, kBlueChannel}) {
    for (RaySample sample : filterSamples(filter, pitch_m)) {
      sample.channels = channel;
      samples.push_back(sample);
    }
  }
  return samples;
}

Camera sampledCamera(const Camera& camera, const RaySample& sample, double focus_m) {
  Camera sampled = camera;
  sampled.pose.position_m += camera.pose.orientation * glm::dvec3(sample.eye_m, 0.0);
  // A point at the focus lies the less to the right the further right the eye is; rows run down.
  const glm::dvec2 moved = camera.intrinsics.focal_px * sample.eye_m / focus_m;
  sampled.intrinsics.principal_px += glm::dvec2(moved.x, -moved.y) - sample.px;
  return sampled;
}

}  // namespace viewloom
