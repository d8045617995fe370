// SPDX-License-Identifier: Apache-2.0
#include "sweep/describe_swept.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sweep/packed_codes.h"

namespace viewloom {
namespace {

uint8_t classOf(const SweptRow& swept, uint32_t p) {
  if (swept.inv_z[p] < 0) return swept.class_of_hole[p];
  const bool is_assumed = swept.has_passed && swept.passed_inv_z[0][p] > swept.inv_z[p];
  return uint8_t(is_assumed ? abi::kClassHitAssumed : abi::kClassHit);
}

// A channel of a blend, 0..1, sRGB-encoded, before it is rounded.
float channelOf(const uint32_t* texels, float share, int shift, uint32_t mask, float steps) {
  const float from = float(texels[0] >> shift & mask);
  const float to = float(texels[1] >> shift & mask);
  return std::lerp(from, to, share) / (steps * 255);
}

void writeLinear(const RowToDescribe& described, uint32_t p, float* rgba) {
  const int32_t place = described.swept.texel[p];
  rgba[3] = 1;
  if (place < 0) {
    for (int i = 0; i < 3; ++i) rgba[i] = float(described.fill.background >> (8 * i) & 255) / 255;
    return;
  }
  const uint32_t* const texels = described.row.texels.data() + place / kSubtexelSteps;
  const float share = float(place % kSubtexelSteps) / kSubtexelSteps;
  rgba[0] = channelOf(texels, share, 0, kRedMask, kRedSteps);
  rgba[1] = channelOf(texels, share, kGreenShift, kGreenMask, kGreenSteps);
  rgba[2] = channelOf(texels, share, kBlueShift, kBlueMask, kBlueSteps);
}

abi::RayRecord recordOf(const RowToDescribe& described, uint32_t p, uint8_t ray_class) {
  const SweptRow& swept = described.swept;
  const float inv_z = std::max(swept.inv_z[p], 0.0F);
  const SweepView& view = described.view;
  const int32_t place = std::max(swept.texel[p], 0);
  // A texel reaches half a px to both sides of its sample.
  const uint32_t texel = uint32_t(place + kSubtexelSteps / 2) / kSubtexelSteps;
  return {.x_px = view.placeAt(float(p), inv_z),
          .y_px = float(described.y_px),
          .inv_z = inv_z,
          .ray_class = ray_class,
          .layer = swept.inv_z[p] < 0 ? 0U : described.row.texel_layer[texel],
          .visits = 0};
}

// The same as applyEdgeBlends.
void blendLinear(const EdgeBlends& blends, float* rgba) {
  std::vector<float> others;
  for (uint32_t i = 0; i < blends.count; ++i) {
    const float* const other = rgba + 4 * size_t(blends.at[i].other);
    others.insert(others.end(), other, other + 4);
  }
  for (size_t i = 0; i < others.size(); ++i) {
    float& channel = rgba[4 * size_t(blends.at[i / 4].px) + i % 4];
    channel = std::lerp(channel, others[i], blends.at[i / 4].share);
  }
}

}  // namespace

void describeSwept(const RowToDescribe& described, size_t at_px, const TraceOutputs& outputs,
                   SweptAtlas& atlas) {
  for (uint32_t p = 0; p < described.width_px; ++p) {
    const uint8_t ray_class = classOf(described.swept, p);
    const size_t at = at_px + size_t{p} * described.stride_px;
    if (outputs.depth) {
      atlas.depth[at] = std::max(described.swept.inv_z[p], 0.0F) * described.view_z;
    }
    if (outputs.mask) atlas.mask[at] = ray_class;
    if (outputs.linear) writeLinear(described, p, atlas.linear.data() + 4 * at);
    if (outputs.records) atlas.records[at] = recordOf(described, p, ray_class);
  }
  if (outputs.linear && described.stride_px == 1)
    blendLinear(described.swept.blends, atlas.linear.data() + 4 * at_px);
}

}  // namespace viewloom
