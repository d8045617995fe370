// SPDX-License-Identifier: Apache-2.0
#include "cli/synthetic_frames.h"

#include <chrono>

#include "base/str_cat.h"
#include "synthetic/synthetic_wire_frame.h"

namespace viewloom::cli {

int64_t captureTimeNs() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

namespace {

// So far apart that each sees much of what the nearest surfaces, 1.8 m away, hide from the next.
constexpr double kSourcesApart_m = 0.4;

// The first stands where the scene is meant to be seen from; the others beside it, right and left
// in turn.
Camera cameraOf(uint32_t source, SizePx size_px) {
  Camera camera = syntheticCamera(size_px);
  const double side = source % 2 == 1 ? 1 : -1;
  camera.pose.position_m.x = side * kSourcesApart_m * ((source + 1) / 2);
  return camera;
}

WireFrame cubeMapFrame(const SyntheticOptions& scene) {
  WireFrame frame;
  frame.header.set_capture_time_ns(captureTimeNs());
  addSyntheticCubeMap(scene, frame);
  return frame;
}

}  // namespace

SyntheticFrames::SyntheticFrames(const SyntheticFeedOptions& options) : options_(options) {}

absl::StatusOr<std::optional<WireFrame>> SyntheticFrames::next(double elapsed_s) {
  if (options_.duration_s > 0 && elapsed_s >= options_.duration_s) {
    return std::optional<WireFrame>();
  }
  SyntheticOptions scene{.size_px = options_.size_px,
                         .layer_count = options_.layer_count,
                         .time_s = elapsed_s,
                         .camera = {},
                         .has_mirrors = options_.has_mirrors};
  if (options_.is_cube_map) return cubeMapFrame(scene);
  WireFrame frame = syntheticWireFrame(scene, captureTimeNs());
  for (uint32_t source = 1; source < options_.source_count; ++source) {
    scene.camera = cameraOf(source, options_.size_px);
    addSyntheticSource(scene, frame);
  }
  return frame;
}

std::string SyntheticFrames::description() const {
  const uint32_t side_px = options_.size_px.height;
  const SizePx size_px = options_.is_cube_map ? SizePx{side_px, side_px} : options_.size_px;
  return strCat("synthetic scene", options_.has_mirrors ? " with mirrors, " : ", ",
                options_.is_cube_map ? "cube map of " : "", size_px.width, "x", size_px.height,
                ", ", options_.layer_count, options_.layer_count == 1 ? " layer" : " layers",
                options_.source_count == 1 ? "" : strCat(", ", options_.source_count, " sources"));
}

}  // namespace viewloom::cli
