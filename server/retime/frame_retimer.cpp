// SPDX-License-Identifier: Apache-2.0
#include "retime/frame_retimer.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "frame/limits.h"
#include "shared/structure_abi.h"

namespace viewloom {
namespace {

bool moves(const std::vector<LayerPlanes>& layers) {
  return std::any_of(layers.begin(), layers.end(),
                     [](const LayerPlanes& layer) { return layer.motion != nullptr; });
}

FramePtr sourceAlone(const Frame& frame, size_t index) {
  auto alone = std::make_shared<Frame>();
  alone->format = frame.format;
  alone->format.sources = {frame.format.sources[index]};
  alone->sources = {frame.sources[index]};
  return alone;
}

// Describes a source whose layers were made anew: columns were sorted, so any layer may mirror.
void describeRetimed(SourceFormat& source) {
  const auto mirror = std::find_if(source.layers.begin(), source.layers.end(),
                                   [](const LayerFormat& layer) { return layer.mirrors(); });
  std::vector<PlaneFormat> others;
  if (mirror != source.layers.end()) others = mirror->others;
  std::erase_if(others, [](const PlaneFormat& plane) { return plane.kind == PlaneKind::kMotion; });
  for (LayerFormat& layer : source.layers) {
    layer.depth = {
        .kind = PlaneKind::kDepth,
        .encoding = PlaneEncoding::kDepthF32,
        .size_px = layer.depth.size_px,
        .depth = {.meaning = DepthMeaning::kDisparity, .invalid_value = double{abi::kNoSurface}}};
    layer.depth.wire_bytes = uncompressedBytes(layer.depth);
    layer.others = others;
    layer.color_has_reflections = false;
  }
}

}  // namespace

FramePtr FrameRetimer::retime(const FramePtr& frame, double seconds, Guesses guesses,
                              const BetweenSteps& between_steps) {
  if (frame != prepared_) {
    prepared_ = nullptr;  // until all sources are those of the frame
    sources_.resize(frame->sources.size());
    for (size_t i = 0; i < sources_.size(); ++i) {
      if (!moves(frame->sources[i])) continue;
      sources_[i].prepare(sourceAlone(*frame, i), workers_);
      between_steps();
    }
    prepared_ = frame;
  }
  auto retimed = std::make_shared<Frame>(*frame);
  for (size_t i = 0; i < sources_.size(); ++i) {
    if (!moves(frame->sources[i])) continue;
    describeRetimed(retimed->format.sources[i]);
    retimed->sources[i] = sources_[i].retime(seconds, guesses, pool_, workers_, between_steps);
  }
  return retimed;
}

}  // namespace viewloom
