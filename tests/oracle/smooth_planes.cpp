// SPDX-License-Identifier: Apache-2.0
#include "oracle/smooth_planes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace viewloom::oracle {
namespace {

struct Place {
  int column = 0;
  int row = 0;
};

// The inv_z of the surfaces there that is nearest to the given one; kNoSurface without any.
float nearestAt(const InvZPlanes& planes, const Place& place, float inv_z) {
  if (place.column < 0 || place.column >= planes.width) return kNoSurface;
  if (place.row < 0 || place.row >= planes.height) return kNoSurface;
  float nearest = kNoSurface;
  for (int layer = 0; layer < planes.layer_count; ++layer) {
    const float other = planes.at(layer, place.column, place.row);
    if (other < 0) continue;
    if (nearest < 0 || std::abs(other - inv_z) < std::abs(nearest - inv_z)) nearest = other;
  }
  return nearest;
}

// How far the mean of a pair lies from inv_z, as far as it counts.
float bendOf(float a, float b, float inv_z, float reach) {
  if (a <= 0 || b <= 0) return 0;
  const float bend = ((a - inv_z) + (b - inv_z)) / 2;
  const float most = std::max(4 * reach - std::max(std::abs(bend), std::abs(b - a)), 0.0f);
  return std::clamp(bend, -most, most);
}

// Limit of a sample's move: its reach, and a quarter of the way to the next layer.
float withinReach(const InvZPlanes& samples, int layer, const Place& place, float inv_z,
                  float reach) {
  const float sample = samples.at(layer, place.column, place.row);
  float up = reach, behind = 0;
  if (layer > 0) {
    up = std::min(up, (samples.at(layer - 1, place.column, place.row) - sample) / 4);
  }
  if (layer + 1 < samples.layer_count) {
    behind = std::max(samples.at(layer + 1, place.column, place.row), 0.0f);
  }
  const float down = std::min(reach, (sample - behind) / 4);
  return std::min(std::max(inv_z, sample - down), sample + up);
}

InvZPlanes afterPass(const InvZPlanes& planes, const InvZPlanes& samples, int stride, float reach) {
  InvZPlanes result = samples;
  for (int layer = 0; layer < samples.layer_count; ++layer) {
    for (int row = 0; row < samples.height; ++row) {
      for (int column = 0; column < samples.width; ++column) {
        if (samples.at(layer, column, row) <= 0) continue;
        const float inv_z = planes.at(layer, column, row);
        const auto pair = [&](int dx, int dy) {
          const float a = nearestAt(planes, {column - dx, row - dy}, inv_z);
          const float b = nearestAt(planes, {column + dx, row + dy}, inv_z);
          return bendOf(a, b, inv_z, reach);
        };
        float sum = pair(stride, 0) + pair(0, stride);
        sum += pair(stride, stride);
        sum += pair(stride, -stride);
        result.at(layer, column, row) =
            withinReach(samples, layer, {column, row}, inv_z + sum / 8, reach);
      }
    }
  }
  return result;
}

}  // namespace

InvZPlanes smoothedPlanes(const InvZPlanes& canonical_planes, const Coarseness& coarseness) {
  if (coarseness.reach <= 0) return canonical_planes;
  const bool is_noise = coarseness.sigma > 2 * coarseness.step;
  InvZPlanes planes = canonical_planes;
  for (const int stride : {32, 16, 8, 4, 2, 1, 1, 1}) {
    if (is_noise && stride > 2) continue;
    planes = afterPass(planes, canonical_planes, stride, coarseness.reach);
  }
  return planes;
}

}  // namespace viewloom::oracle
