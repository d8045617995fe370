// SPDX-License-Identifier: Apache-2.0
#include "sweep/light_sums.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/srgb.h"

namespace viewloom {
namespace {

// Steps of the root of light that are told apart. From code to code there are 18 or more, so that a
// mean is off by half a code and an eighteenth of that at most.
constexpr uint32_t kRootSteps = 4096;

uint8_t codeOfLight(double light) {
  return uint8_t(std::lround(255 * srgbFromLinear(light)));
}

// By the root of light, in the middle of each step.
const std::array<uint8_t, kRootSteps + 1>& codesOfRoots() {
  static const std::array<uint8_t, kRootSteps + 1> table = [] {
    std::array<uint8_t, kRootSteps + 1> codes;
    for (uint32_t step = 0; step <= kRootSteps; ++step) {
      const double root = double(step) / kRootSteps;
      codes[step] = codeOfLight(root * root);
    }
    return codes;
  }();
  return table;
}

}  // namespace

void LightSums::begin(uint32_t tile_count, uint32_t width_px) {
  width_px_ = width_px;
  sums_.assign(size_t{tile_count} * width_px * 3, 0.0F);
}

void LightSums::add(uint32_t tile, const uint32_t* rgba) {
  const std::array<float, 256>& light = lightOfCodes();
  float* const sums = &sums_[size_t{tile} * width_px_ * 3];
  for (uint32_t x = 0; x < width_px_; ++x) {
    for (uint32_t channel = 0; channel < 3; ++channel) {
      sums[3 * x + channel] += light[rgba[x] >> (8 * channel) & 0xff];
    }
  }
}

void LightSums::mean(uint32_t tile, uint32_t count, uint32_t* rgba) const {
  const std::array<uint8_t, kRootSteps + 1>& codes = codesOfRoots();
  const float* const sums = &sums_[size_t{tile} * width_px_ * 3];
  const float share = 1.0F / float(count);
  for (uint32_t x = 0; x < width_px_; ++x) {
    uint32_t packed = 0xff000000;
    for (uint32_t channel = 0; channel < 3; ++channel) {
      const float root = std::sqrt(std::min(sums[3 * x + channel] * share, 1.0F));
      packed |= uint32_t{codes[uint32_t(root * float(kRootSteps) + 0.5F)]} << (8 * channel);
    }
    rgba[x] = packed;
  }
}

}  // namespace viewloom
