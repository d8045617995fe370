// SPDX-License-Identifier: Apache-2.0
#include "retime/fresh_layer.h"

#include <algorithm>
#include <cstring>

#include "frame/limits.h"
#include "sweep/row_source.h"

namespace viewloom {
namespace {

// By this share of its 1/Z a guess stands behind what it was guessed from. Surfaces are one within
// 2 %, or within a few of the depth's own steps, which should not be what this adds; a deep step
// (abi::kDeepStep) begins at 15 %.
constexpr float kGivesWayShare = 0.1F;

// Texels where there is something, zeros elsewhere; `from` may be null.
template <typename Texel>
void copyTexels(const float* inv_z, const uint8_t* from, uint32_t count, uint8_t* to) {
  if (from == nullptr) {
    std::fill_n(to, count * sizeof(Texel), uint8_t{0});
    return;
  }
  for (uint32_t i = 0; i < count; ++i) {
    Texel texel;
    std::memcpy(&texel, from + i * sizeof texel, sizeof texel);
    texel = inv_z[i] >= 0 ? texel : Texel{0};
    std::memcpy(to + i * sizeof texel, &texel, sizeof texel);
  }
}

}  // namespace

void FreshRow::reserve(uint32_t width) {
  blends.reserve(width);
  marked.reserve(width + kRowSlack);
}

size_t texelBytes(PlaneEncoding encoding) {
  return encoding == PlaneEncoding::kRgba16f ? 8 : 4;
}

FreshLayer::FreshLayer(const MovedSurfaces& surfaces, const EdgeLight& edges, uint32_t layer,
                       const FreshPlanes& to)
    : surfaces_(surfaces),
      edges_(edges),
      layer_(layer),
      to_(to),
      from_(surfaces.frame().sources.front()),
      encoding_(from_.front().color_encoding) {}

void FreshLayer::writeRow(uint32_t y, FreshRow& fresh) const {
  const uint32_t width = surfaces_.sizePx().width;
  const Columns columns = surfaces_.freshColumns(y);
  writeStanding(y, {0, columns.first});
  writeStanding(y, {columns.end, width});
  const uint32_t px = y * width + columns.first;
  const BlendedRow& blends = fresh.blends;
  std::copy_n(blends.inv_z.data(), columns.count(), to_.inv_z + px);
  writeColors(px, columns.count(), fresh);
  if (to_.surface != nullptr) writeSurfaces(px, columns.count(), blends);
  if (to_.samples == nullptr) return;
  for (uint32_t i = 0; i < columns.count(); ++i) {
    to_.samples[px + i] = blends.inv_z[i] >= 0 ? blends.main[i] : kNoSample;
  }
}

// Columns are in canonical form: what stands on a layer stays on it.
void FreshLayer::writeStanding(uint32_t y, const Columns& columns) const {
  if (columns.isEmpty()) return;
  const uint32_t px = y * surfaces_.sizePx().width + columns.first;
  const uint32_t count = columns.count();
  const float* const inv_z = surfaces_.heldRow(layer_, y) + columns.first;
  std::copy_n(inv_z, count, to_.inv_z + px);
  const uint8_t* const color = from_[layer_].color->data() + px * texelBytes(encoding_);
  uint8_t* const to_color = to_.color + px * texelBytes(encoding_);
  if (encoding_ == PlaneEncoding::kRgba16f) {
    copyTexels<uint64_t>(inv_z, color, count, to_color);
  } else {
    copyTexels<uint32_t>(inv_z, color, count, to_color);
  }
  if (to_.surface != nullptr) {
    static_assert(kSurfaceTexelBytes == sizeof(uint64_t));
    const SharedBytes& surface = from_[layer_].surface;
    copyTexels<uint64_t>(inv_z,
                         surface == nullptr ? nullptr : surface->data() + px * kSurfaceTexelBytes,
                         count, to_.surface + px * kSurfaceTexelBytes);
  }
  if (to_.samples == nullptr) return;
  for (uint32_t i = 0; i < count; ++i) to_.samples[px + i] = inv_z[i] >= 0 ? px + i : kNoSample;
}

void FreshLayer::writeColors(uint32_t px, uint32_t count, FreshRow& fresh) const {
  if (encoding_ != PlaneEncoding::kRgba16f) {
    blendBytes(px, count, fresh);
    return;
  }
  for (uint32_t i = 0; i < count; ++i) {
    if (fresh.blends.inv_z[i] >= 0) {
      blendPx(px + i, i, fresh.blends);
    } else {
      std::fill_n(to_.color + (px + i) * texelBytes(encoding_), texelBytes(encoding_), uint8_t{0});
    }
  }
}

// All at once, and anew those of samples that have not their own light.
void FreshLayer::blendBytes(uint32_t px, uint32_t count, FreshRow& fresh) const {
  TexelPlanes planes{.area_px = uint32_t(surfaces_.sizePx().area()), .marks = edges_.rims()};
  for (size_t i = 0; i < from_.size(); ++i) planes.color[i] = from_[i].color->data();
  const uint32_t marked_count =
      blendTexels(planes, fresh.blends, count, to_.color + size_t{4} * px, fresh.marked.data());
  for (uint32_t i = 0; i < marked_count; ++i) {
    blendPx(px + fresh.marked[i], fresh.marked[i], fresh.blends);
  }
}

void FreshLayer::blendPx(uint32_t px, uint32_t i, const BlendedRow& fresh) const {
  const uint32_t first = fresh.samples[0][i];
  const uint32_t count = fresh.samples[1][i] == first ? 1 : 3;
  const bool stands = count == 1 && surfaces_.pxOf(first) == px && !surfaces_.moves(first);
  if (stands && edges_.cleanAt(first) == nullptr) {
    const size_t texel_bytes = texelBytes(encoding_);
    const uint8_t* const color = from_[surfaces_.layerOf(first)].color->data();
    std::copy_n(color + px * texel_bytes, texel_bytes, to_.color + px * texel_bytes);
    return;
  }
  Texel sum{};
  for (uint32_t k = 0; k < count; ++k) {
    const uint32_t sample = fresh.samples[k][i];
    const Texel* const clean = edges_.cleanAt(sample);
    const ColorPlane plane{from_[surfaces_.layerOf(sample)].color->data(), encoding_};
    const Texel texel = clean != nullptr ? *clean : plane.at(surfaces_.pxOf(sample));
    for (size_t c = 0; c < sum.size(); ++c) sum[c] += fresh.shares[k][i] * texel[c];
  }
  storeTexel(encoding_, sum, px, to_.color);
}

void FreshLayer::writeSurfaces(uint32_t px, uint32_t count, const BlendedRow& fresh) const {
  for (uint32_t i = 0; i < count; ++i) {
    uint8_t* const to = to_.surface + (px + i) * kSurfaceTexelBytes;
    std::fill_n(to, kSurfaceTexelBytes, uint8_t{0});
    if (fresh.inv_z[i] < 0) continue;
    const SharedBytes& from = from_[surfaces_.layerOf(fresh.main[i])].surface;
    if (from == nullptr) continue;
    std::copy_n(from->data() + surfaces_.pxOf(fresh.main[i]) * kSurfaceTexelBytes,
                kSurfaceTexelBytes, to);
  }
}

void FreshLayer::copyPx(uint32_t from, uint32_t to) const {
  const size_t texel_bytes = texelBytes(encoding_);
  std::copy_n(to_.color + from * texel_bytes, texel_bytes, to_.color + to * texel_bytes);
  if (to_.samples != nullptr) to_.samples[to] = to_.samples[from];
  if (to_.surface == nullptr) return;
  std::copy_n(to_.surface + from * kSurfaceTexelBytes, kSurfaceTexelBytes,
              to_.surface + to * kSurfaceTexelBytes);
}

void FreshLayer::fillRow(uint32_t y, Guesses guesses) const {
  const uint32_t width = surfaces_.sizePx().width;
  const Columns columns = surfaces_.freshColumns(y);
  const uint32_t row = y * width;
  float* const inv_z = to_.inv_z + row;
  const float* const held = surfaces_.heldRow(0, y);
  const float share = guesses == Guesses::kGiveWay ? 1 - kGivesWayShare : 1;
  for (uint32_t x = columns.first; x < columns.end; ++x) {
    if (inv_z[x] >= 0) continue;
    uint32_t begin = x, end = x;
    while (begin > 0 && inv_z[begin - 1] < 0) --begin;
    while (end < width && inv_z[end] < 0) ++end;
    const bool has_left = begin > 0, has_right = end < width;
    if (!has_left && !has_right) return;
    const bool takes_left = has_left && (!has_right || inv_z[begin - 1] <= inv_z[end]);
    const uint32_t from = takes_left ? begin - 1 : end;
    for (; x < end; ++x) {
      if (held[x] < 0) continue;
      inv_z[x] = share * inv_z[from];
      copyPx(row + from, row + x);
    }
  }
}

}  // namespace viewloom
