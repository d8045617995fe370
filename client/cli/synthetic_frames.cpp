// SPDX-License-Identifier: Apache-2.0
#include "cli/synthetic_frames.h"

#include <cmath>
#include <numbers>

#include "base/str_cat.h"
#include "synthetic/synthetic_wire_frame.h"

namespace viewloom::cli {
namespace {

// So far apart that each sees much of what the nearest surfaces, 1.8 m away, hide from the next.
constexpr double kSourcesApart_m = 0.4;

// Where the scene is meant to be seen from, or in a hand that sways around there.
Pose firstPose(bool is_moving, double time_s) {
  if (!is_moving) return {};
  const auto wave = [&](double rate_hz) {
    return std::sin(2 * std::numbers::pi * rate_hz * time_s);
  };
  return {.position_m = {0.3 * wave(0.31), 0.08 * wave(0.43), 0.1 * wave(0.23)},
          .orientation = glm::dquat(glm::dvec3(0.02 * wave(0.37), 0.06 * wave(0.29), 0))};
}

// The first stands at `first`; the others beside it, right and left in turn.
Camera cameraOf(uint32_t source, const Pose& first, SizePx size_px) {
  Camera camera = syntheticCamera(size_px);
  const double side = source % 2 == 1 ? 1 : -1;
  const double beside_m = side * kSourcesApart_m * ((source + 1) / 2);
  camera.pose = compose(first, {.position_m = {source == 0 ? 0 : beside_m, 0, 0}});
  return camera;
}

SyntheticFeedOptions withSize(SyntheticFeedOptions options) {
  constexpr SizePx kBalls_px{960, 540};
  constexpr SizePx kPortrait_px{720, 960};
  if (options.size_px.width > 0) return options;
  options.size_px = options.setting == synthetic::Setting::kPortrait ? kPortrait_px : kBalls_px;
  return options;
}

WireFrame cubeMapFrame(const SyntheticOptions& scene) {
  WireFrame frame;
  frame.header.set_capture_time_ns(captureTimeNs());
  addSyntheticCubeMap(scene, frame);
  return frame;
}

}  // namespace

SyntheticFrames::SyntheticFrames(const SyntheticFeedOptions& options)
    : options_(withSize(options)) {}

absl::StatusOr<std::optional<WireFrame>> SyntheticFrames::next(double elapsed_s) {
  if (options_.duration_s > 0 && elapsed_s >= options_.duration_s) {
    return std::optional<WireFrame>();
  }
  SyntheticOptions scene{.size_px = options_.size_px,
                         .layer_count = options_.layer_count,
                         .time_s = elapsed_s,
                         .camera = {},
                         .has_mirrors = options_.has_mirrors,
                         .has_motion = options_.has_motion,
                         .setting = options_.setting};
  const Pose first = firstPose(options_.has_moving_camera, elapsed_s);
  if (options_.is_cube_map) return cubeMapFrame(scene);
  if (options_.has_moving_camera) scene.camera = cameraOf(0, first, options_.size_px);
  WireFrame frame = syntheticWireFrame(scene, captureTimeNs());
  for (uint32_t source = 1; source < options_.source_count; ++source) {
    scene.camera = cameraOf(source, first, options_.size_px);
    addSyntheticSource(scene, frame);
  }
  return frame;
}

std::string SyntheticFrames::description() const {
  const uint32_t side_px = options_.size_px.height;
  const SizePx size_px = options_.is_cube_map ? SizePx{side_px, side_px} : options_.size_px;
  const bool is_portrait = options_.setting == synthetic::Setting::kPortrait;
  return strCat(is_portrait ? "portrait scene" : "synthetic scene",
                options_.has_mirrors ? " with mirrors, " : ", ",
                options_.is_cube_map ? "cube map of " : "", size_px.width, "x", size_px.height,
                ", ", options_.layer_count, options_.layer_count == 1 ? " layer" : " layers",
                options_.source_count == 1 ? "" : strCat(", ", options_.source_count, " sources"));
}

}  // namespace viewloom::cli
