// SPDX-License-Identifier: Apache-2.0
#include "retime/source_retimer.h"

#include <algorithm>
#include <utility>

#include "frame/limits.h"

namespace viewloom {
namespace {

// By this share of its 1/Z a guess stands behind what it was guessed from. Surfaces are one within
// 2 %, or within a few of the depth's own steps, which should not be what this adds; a deep step
// (abi::kDeepStep) begins at 15 %.
constexpr float kGivesWayShare = 0.1F;

size_t texelBytes(PlaneEncoding encoding) {
  return encoding == PlaneEncoding::kRgba16f ? 8 : 4;
}

// The sample that most of the px is.
uint32_t mainSample(const Blend& blend) {
  const auto most = std::max_element(blend.shares.begin(), blend.shares.begin() + blend.count);
  return blend.samples[size_t(most - blend.shares.begin())];
}

bool mirrors(const std::vector<LayerPlanes>& layers) {
  return std::any_of(layers.begin(), layers.end(),
                     [](const LayerPlanes& layer) { return layer.surface != nullptr; });
}

}  // namespace

std::vector<LayerPlanes> SourceRetimer::retime(double seconds, Guesses guesses, BytePool& pool,
                                               WorkerPool& workers) {
  surfaces_.move(seconds, workers);
  edges_.find(surfaces_, workers);
  const SizePx size_px = surfaces_.sizePx();
  std::vector<LayerPlanes> layers;
  std::vector<Written> written;
  front_samples_.assign(size_px.area(), kNoSample);
  for (uint32_t layer = 0; layer < surfaces_.layerCount(); ++layer) {
    if (layer == 0) {
      grid_.drawFirst(surfaces_, workers);
    } else {
      grid_.drawNext(surfaces_, workers);
    }
    Written to;
    layers.push_back(takeLayer(pool, to));
    written.push_back(to);
    workers.forEach(retimedPieceCount(size_px), [&](uint32_t piece, uint32_t) {
      const uint32_t first = piece * kRetimedRowsPerPiece;
      const uint32_t end = std::min(first + kRetimedRowsPerPiece, size_px.height);
      for (uint32_t y = first; y < end; ++y) {
        for (uint32_t x = 0; x < size_px.width; ++x) {
          const uint32_t main = writePx(y * size_px.width + x, to);
          if (layer == 0) front_samples_[y * size_px.width + x] = main;
        }
        if (layer == 0) fillRow(y, guesses, to);
      }
    });
  }
  EdgeLight::Drawn drawn{
      .inv_z = written[0].inv_z, .sample = front_samples_.data(), .color = written[0].color};
  if (written.size() > 1) {
    drawn.inv_z_behind = written[1].inv_z;
    drawn.behind = {written[1].color, layers[1].color_encoding};
  }
  edges_.blendInto(surfaces_, drawn, workers);
  return layers;
}

LayerPlanes SourceRetimer::takeLayer(BytePool& pool, Written& to) const {
  const std::vector<LayerPlanes>& from = surfaces_.frame().sources.front();
  const size_t px_count = surfaces_.sizePx().area();
  const auto take = [&](size_t texel_bytes) {
    BytePool::Buffer buffer = pool.take(px_count * texel_bytes);
    buffer->resize(px_count * texel_bytes);
    return buffer;
  };
  LayerPlanes layer;
  layer.color_encoding = from.front().color_encoding;
  BytePool::Buffer depth = take(sizeof(float));
  BytePool::Buffer color = take(texelBytes(layer.color_encoding));
  to = {.inv_z = reinterpret_cast<float*>(depth->data()), .color = color->data()};
  layer.depth = std::move(depth);
  layer.color = std::move(color);
  if (mirrors(from)) {
    BytePool::Buffer surface = take(kSurfaceTexelBytes);
    to.surface = surface->data();
    layer.surface = std::move(surface);
  }
  return layer;
}

uint32_t SourceRetimer::writePx(uint32_t px, const Written& to) const {
  const std::vector<LayerPlanes>& from = surfaces_.frame().sources.front();
  const size_t texel_bytes = texelBytes(from.front().color_encoding);
  to.inv_z[px] = grid_.invZ(px);
  if (to.surface != nullptr) {
    std::fill_n(to.surface + px * kSurfaceTexelBytes, kSurfaceTexelBytes, uint8_t{0});
  }
  if (to.inv_z[px] < 0) {
    std::fill_n(to.color + px * texel_bytes, texel_bytes, uint8_t{0});
    return kNoSample;
  }
  uint32_t main = 0;
  const std::optional<uint32_t> still = grid_.stillSample(px);
  if (still && edges_.cleanAt(*still) == nullptr) {
    main = *still;
    const LayerPlanes& layer = from[surfaces_.layerOf(main)];
    std::copy_n(layer.color->data() + px * texel_bytes, texel_bytes, to.color + px * texel_bytes);
  } else {
    main = blendPx(px, to);
  }
  const SharedBytes& surface = from[surfaces_.layerOf(main)].surface;
  if (surface == nullptr) return main;
  std::copy_n(surface->data() + surfaces_.pxOf(main) * kSurfaceTexelBytes, kSurfaceTexelBytes,
              to.surface + px * kSurfaceTexelBytes);
  return main;
}

// Returns the sample that most of it is.
uint32_t SourceRetimer::blendPx(uint32_t px, const Written& to) const {
  const std::vector<LayerPlanes>& from = surfaces_.frame().sources.front();
  const PlaneEncoding encoding = from.front().color_encoding;
  const Blend blend = grid_.blend(surfaces_, px);
  Texel sum{};
  for (uint32_t i = 0; i < blend.count; ++i) {
    const uint32_t sample = blend.samples[i];
    const Texel* const clean = edges_.cleanAt(sample);
    const ColorPlane plane{from[surfaces_.layerOf(sample)].color->data(), encoding};
    const Texel texel = clean != nullptr ? *clean : plane.at(surfaces_.pxOf(sample));
    for (size_t c = 0; c < sum.size(); ++c) sum[c] += float(blend.shares[i]) * texel[c];
  }
  storeTexel(encoding, sum, px, to.color);
  return mainSample(blend);
}

// Of px at which the frame has a surface, and nothing is any more.
void SourceRetimer::fillRow(uint32_t y, Guesses guesses, const Written& to) {
  const uint32_t width = surfaces_.sizePx().width;
  const size_t texel_bytes = texelBytes(surfaces_.frame().sources.front().front().color_encoding);
  const uint32_t row = y * width;
  const float share = guesses == Guesses::kGiveWay ? 1 - kGivesWayShare : 1;
  uint32_t x = 0;
  while (x < width) {
    if (grid_.invZ(row + x) >= 0) {
      ++x;
      continue;
    }
    uint32_t end = x;
    while (end < width && grid_.invZ(row + end) < 0) ++end;
    const bool has_left = x > 0, has_right = end < width;
    const bool takes_left =
        has_left && (!has_right || grid_.invZ(row + x - 1) <= grid_.invZ(row + end));
    const uint32_t from = row + (takes_left ? x - 1 : end);
    for (; x < end; ++x) {
      if ((!has_left && !has_right) || !surfaces_.hadSurface(x, y)) continue;
      const uint32_t px = row + x;
      to.inv_z[px] = share * grid_.invZ(from);
      front_samples_[px] = front_samples_[from];
      std::copy_n(to.color + from * texel_bytes, texel_bytes, to.color + px * texel_bytes);
      if (to.surface == nullptr) continue;
      std::copy_n(to.surface + from * kSurfaceTexelBytes, kSurfaceTexelBytes,
                  to.surface + px * kSurfaceTexelBytes);
    }
  }
}

}  // namespace viewloom
