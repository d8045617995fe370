// SPDX-License-Identifier: Apache-2.0
#include "retime/source_retimer.h"

#include <algorithm>
#include <utility>

#include "frame/limits.h"

namespace viewloom {
namespace {

bool mirrors(const std::vector<LayerPlanes>& layers) {
  return std::any_of(layers.begin(), layers.end(),
                     [](const LayerPlanes& layer) { return layer.surface != nullptr; });
}

}  // namespace

std::vector<LayerPlanes> SourceRetimer::retime(double seconds, Guesses guesses, BytePool& pool,
                                               WorkerPool& workers,
                                               const BetweenSteps& between_steps) {
  surfaces_.move(seconds, workers);
  between_steps();
  edges_.find(surfaces_, workers);
  const SizePx size_px = surfaces_.sizePx();
  front_samples_.resize(size_px.area());
  rows_.resize(workers.workerCount());
  for (FreshRow& row : rows_) row.reserve(size_px.width);
  std::vector<LayerPlanes> layers;
  std::vector<FreshPlanes> written;
  for (uint32_t layer = 0; layer < surfaces_.layerCount(); ++layer) {
    between_steps();
    grid_.draw(surfaces_, layer == 0 ? nullptr : written.back().inv_z, workers);
    FreshPlanes to;
    layers.push_back(takeLayer(pool, to));
    if (layer == 0) to.samples = front_samples_.data();
    written.push_back(to);
    between_steps();
    const FreshLayer fresh(surfaces_, edges_, layer, to);
    forEachRow(size_px, workers, [&](uint32_t y, uint32_t worker) {
      grid_.findRow(y, rows_[worker].blends);
      fresh.writeRow(y, rows_[worker]);
      if (layer == 0) fresh.fillRow(y, guesses);
    });
  }
  between_steps();
  EdgeLight::Drawn drawn{
      .inv_z = written[0].inv_z, .sample = front_samples_.data(), .color = written[0].color};
  if (written.size() > 1) {
    drawn.inv_z_behind = written[1].inv_z;
    drawn.behind = {written[1].color, layers[1].color_encoding};
  }
  edges_.blendInto(surfaces_, drawn, workers);
  return layers;
}

LayerPlanes SourceRetimer::takeLayer(BytePool& pool, FreshPlanes& to) const {
  const std::vector<LayerPlanes>& from = surfaces_.frame().sources.front();
  const size_t px_count = surfaces_.sizePx().area();
  const auto take = [&](size_t texel_bytes) { return pool.takeAsLeft(px_count * texel_bytes); };
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

}  // namespace viewloom
