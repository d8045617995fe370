// SPDX-License-Identifier: Apache-2.0
#include "gpu/world_views.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace viewloom {
namespace {

DisplaySpec displayOf(const std::vector<Camera>& views, SizePx view_px, uint32_t fineness) {
  CamerasSpec cameras{.cameras = {},
                      .tile_size_px = {fineness * view_px.width, fineness * view_px.height},
                      .columns = uint32_t(views.size())};
  for (Camera view : views) {
    view.intrinsics.focal_px *= double(fineness);
    view.intrinsics.principal_px *= double(fineness);
    cameras.cameras.push_back({view.pose, view.intrinsics});
  }
  DisplaySpec spec;
  spec.kind = cameras;
  spec.world_pose = Pose{};
  spec.tolerance_px = double(fineness) * kDefaultTolerance_px;
  return spec;
}

template <typename Value>
Value valueOrThrow(absl::StatusOr<Value> value) {
  if (!value.ok()) throw std::runtime_error(std::string(value.status().message()));
  return *std::move(value);
}

}  // namespace

FramePtr twice(const Frame& one) {
  auto both = std::make_shared<Frame>(one);
  both->format.sources.push_back(one.format.sources.front());
  both->sources.push_back(one.sources.front());
  return both;
}

RenderedAtlas renderInWorld(OfflineRenderer& renderer, const Frame& frame,
                            const std::vector<Camera>& views, SizePx view_px, size_t fineness,
                            const std::optional<ReflectionSpec>& reflection) {
  renderer.build(frame);
  DisplaySpec wanted = displayOf(views, view_px, uint32_t(fineness));
  wanted.reflection = reflection;
  const DisplaySpec display = valueOrThrow(completeDisplaySpec(wanted));
  return valueOrThrow(
      renderer.render(display, {.mask = true, .linear = true}, [](uint32_t, uint32_t) {}));
}

}  // namespace viewloom
