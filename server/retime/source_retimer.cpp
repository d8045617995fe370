// SPDX-License-Identifier: Apache-2.0
#include "retime/source_retimer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include <glm/gtc/packing.hpp>

#include "frame/limits.h"

namespace viewloom {
namespace {

constexpr size_t kChannels = 4;

size_t texelBytes(PlaneEncoding encoding) {
  return encoding == PlaneEncoding::kRgba16f ? 8 : 4;
}

double channelAt(PlaneEncoding encoding, const uint8_t* texel, size_t channel) {
  if (encoding != PlaneEncoding::kRgba16f) return texel[channel];
  uint16_t half = 0;
  std::memcpy(&half, texel + 2 * channel, sizeof half);
  return double{glm::unpackHalf1x16(half)};
}

void storeChannel(PlaneEncoding encoding, double value, size_t channel, uint8_t* texel) {
  if (encoding != PlaneEncoding::kRgba16f) {
    texel[channel] = uint8_t(std::clamp(value + 0.5, 0.0, 255.0));
    return;
  }
  const uint16_t half = glm::packHalf1x16(float(value));
  std::memcpy(texel + 2 * channel, &half, sizeof half);
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

std::vector<LayerPlanes> SourceRetimer::retime(double seconds, BytePool& pool,
                                               WorkerPool& workers) {
  surfaces_.move(seconds, workers);
  const SizePx size_px = surfaces_.sizePx();
  std::vector<LayerPlanes> layers;
  for (uint32_t layer = 0; layer < surfaces_.layerCount(); ++layer) {
    if (layer == 0) {
      grid_.drawFirst(surfaces_, workers);
    } else {
      grid_.drawNext(surfaces_, workers);
    }
    Written to;
    layers.push_back(takeLayer(pool, to));
    workers.forEach(retimedPieceCount(size_px), [&](uint32_t piece, uint32_t) {
      const uint32_t first = piece * kRetimedRowsPerPiece;
      const uint32_t end = std::min(first + kRetimedRowsPerPiece, size_px.height);
      for (uint32_t y = first; y < end; ++y) {
        for (uint32_t x = 0; x < size_px.width; ++x) writePx(y * size_px.width + x, to);
        if (layer == 0) fillRow(y, to);
      }
    });
  }
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

void SourceRetimer::writePx(uint32_t px, const Written& to) const {
  const std::vector<LayerPlanes>& from = surfaces_.frame().sources.front();
  const PlaneEncoding encoding = from.front().color_encoding;
  const size_t texel_bytes = texelBytes(encoding);
  uint8_t* const color = to.color + px * texel_bytes;
  to.inv_z[px] = grid_.invZ(px);
  if (to.surface != nullptr) {
    std::fill_n(to.surface + px * kSurfaceTexelBytes, kSurfaceTexelBytes, uint8_t{0});
  }
  if (to.inv_z[px] < 0) {
    std::fill_n(color, texel_bytes, uint8_t{0});
    return;
  }
  const Blend blend = grid_.blend(surfaces_, px);
  const auto texelOf = [&](uint32_t sample) {
    return from[surfaces_.layerOf(sample)].color->data() + surfaces_.pxOf(sample) * texel_bytes;
  };
  if (blend.count == 1) {
    std::copy_n(texelOf(blend.samples[0]), texel_bytes, color);
  } else {
    for (size_t channel = 0; channel < kChannels; ++channel) {
      double value = 0;
      for (uint32_t i = 0; i < blend.count; ++i) {
        value += blend.shares[i] * channelAt(encoding, texelOf(blend.samples[i]), channel);
      }
      storeChannel(encoding, value, channel, color);
    }
  }
  const uint32_t main = mainSample(blend);
  const SharedBytes& surface = from[surfaces_.layerOf(main)].surface;
  if (surface == nullptr) return;
  std::copy_n(surface->data() + surfaces_.pxOf(main) * kSurfaceTexelBytes, kSurfaceTexelBytes,
              to.surface + px * kSurfaceTexelBytes);
}

// Of px at which the frame has a surface, and nothing is any more.
void SourceRetimer::fillRow(uint32_t y, const Written& to) const {
  const uint32_t width = surfaces_.sizePx().width;
  const size_t texel_bytes = texelBytes(surfaces_.frame().sources.front().front().color_encoding);
  const uint32_t row = y * width;
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
      to.inv_z[px] = grid_.invZ(from);
      std::copy_n(to.color + from * texel_bytes, texel_bytes, to.color + px * texel_bytes);
      if (to.surface == nullptr) continue;
      std::copy_n(to.surface + from * kSurfaceTexelBytes, kSurfaceTexelBytes,
                  to.surface + px * kSurfaceTexelBytes);
    }
  }
}

}  // namespace viewloom
