// SPDX-License-Identifier: Apache-2.0
#include "bench/mirror_loads.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "frame/cube_map.h"
#include "scoring/psnr.h"
#include "support/srgb_transfer.h"
#include "support/truth/mirror_scenes.h"
#include "support/truth/picture_frame.h"

namespace viewloom::bench {
namespace {

constexpr SizePx kSource_px{640, 480};
constexpr double kFocal_px = 480;
constexpr uint32_t kLayers = 2;
constexpr uint32_t kEnvironment_rgb = 0x808080;
constexpr uint32_t kSamples = 8;  // a px of a rough surface

constexpr uint32_t kCubeSide_px = 512;  // of a face
const Pose kCube{.position_m = {0, 0.1, -0.3}, .orientation = {1, 0, 0, 0}};

Camera cameraAt(const glm::dvec3& eye_m, const glm::dvec3& turn_rad, SizePx size_px) {
  return {.pose = {.position_m = eye_m, .orientation = glm::dquat(turn_rad)},
          .intrinsics = {glm::dvec2(kFocal_px), {0.5 * size_px.width, 0.5 * size_px.height}}};
}

std::vector<truth::SourceCamera> withCube(std::vector<truth::SourceCamera> cameras) {
  for (uint32_t face = 0; face < kCubeFaceCount; ++face) {
    cameras.push_back({cubeFaceCamera(kCube, face, kCubeSide_px), {kCubeSide_px, kCubeSide_px}});
  }
  return cameras;
}

double linearOf(uint32_t code) {
  return linearFrom((code & 0xff) / 255.0);
}

void add(const float* got, const glm::vec3& truth, Psnr& psnr) {
  for (int c = 0; c < 3; ++c) {
    psnr.add(double{got[c]} - srgbFrom(std::min(double{truth[c]}, 1.0)));
  }
}

}  // namespace

std::vector<MirrorView> mirrorViews() {
  constexpr glm::dvec3 kNone(0);
  return {{"of the source", cameraAt(kNone, kNone, kMirrorView_px)},
          {"beside it", cameraAt({0.15, 0.08, 0}, {0, 0.03, 0}, kMirrorView_px)}};
}

ReflectionSpec MirrorScene::effect() const {
  return {
      .bounce_count = bounce_count, .sample_count = kSamples, .environment_rgb = kEnvironment_rgb};
}

std::vector<glm::vec3> MirrorScene::truthOf(const truth::Instant& instant,
                                            const Camera& view) const {
  return truth::takeMirrored(instant, view, kMirrorView_px,
                             {.bounce_count = bounce_count,
                              .sample_count = sample_count,
                              .environment = glm::vec3(float(linearOf(kEnvironment_rgb)))});
}

bool HeldBy::isKnown(size_t px) const {
  return first[px] < kLayers;
}

bool HeldBy::isElsewhere(size_t px) const {
  return !isKnown(px) && any[px] < kLayers;
}

FramePtr frameOf(const truth::Instant& instant, const Stand& stand) {
  std::vector<truth::Picture> pictures;
  for (const auto& [camera, size_px] : stand.cameras) {
    pictures.push_back(truth::takePicture(
        instant, camera,
        {.size_px = size_px, .layer_count = kLayers, .color = truth::ColorOver::kCenter}));
  }
  if (!stand.has_cube) return truth::frameOf(pictures, kLayers);
  const auto first_face = pictures.end() - kCubeFaceCount;
  const FramePtr cube = truth::cubeFrameOf({first_face, pictures.end()}, kCube, kLayers);
  if (first_face == pictures.begin()) return cube;
  auto both = std::make_shared<Frame>(*truth::frameOf({pictures.begin(), first_face}, kLayers));
  both->format.sources.push_back(cube->format.sources.front());
  both->sources.push_back(cube->sources.front());
  return both;
}

HeldBy heldBy(const truth::Instant& instant, const Stand& stand, const Camera& view) {
  std::vector<truth::SourceCamera> cameras = stand.cameras;
  // In a cube map, the face that looks where the views look is the first.
  if (stand.has_cube && cameras.size() == kCubeFaceCount) {
    std::swap(cameras.front(), cameras[kCubeFrontFace]);
  }
  return {truth::mirroredKnownFrom(instant, {cameras.front()}, view, kMirrorView_px),
          truth::mirroredKnownFrom(instant, cameras, view, kMirrorView_px)};
}

MirrorPsnr mirrorPsnr(const AtlasLayout& layout, std::span<const float> linear,
                      const std::vector<glm::vec3>& truth, const HeldBy& held) {
  const TileOrigin origin = layout.tileOrigin(0);
  Psnr of_known, of_elsewhere, of_unknown, of_all;
  for (size_t i = 0; i < truth.size(); ++i) {
    if (!held.isMirror(i)) continue;
    const size_t x_px = origin.x_px + i % kMirrorView_px.width;
    const size_t y_px = origin.y_px + i / kMirrorView_px.width;
    const float* const got = &linear[4 * (y_px * layout.size_px.width + x_px)];
    add(got, truth[i], of_all);
    Psnr& own = held.isKnown(i) ? of_known : held.isElsewhere(i) ? of_elsewhere : of_unknown;
    add(got, truth[i], own);
  }
  return {of_known.db(), of_elsewhere.db(), of_unknown.db(), of_all.db()};
}

// Scenes whose other sources see what the first cannot: things behind it, or hidden.
std::vector<MirrorScene> mirrorScenes() {
  const truth::SourceCamera own{cameraAt(glm::dvec3(0), glm::dvec3(0), kSource_px), kSource_px};
  const auto beside = [&](const glm::dvec3& eye_m, const glm::dvec3& turn_rad) {
    return std::vector<truth::SourceCamera>{own,
                                            {cameraAt(eye_m, turn_rad, kSource_px), kSource_px}};
  };
  const Stand one{"one", {own}};
  const Stand looks_back{"two", beside({0, 0.1, -1.9}, {0, std::numbers::pi, 0})};
  const Stand looks_up{"two", beside({-0.2, -0.6, -0.8}, {0.35, 0, 0})};
  const Stand has_cube{"one, a cube map", withCube({own}), true};
  const Stand is_cube{"a cube map", withCube({}), true};
  return {{"mirror floor", truth::mirrorFloor(0), 1, 1, {one, looks_up}},
          {"mirror sphere", truth::mirrorSphere(), 1, 1, {one, looks_back, has_cube, is_cube}},
          {"facing mirrors", truth::facingMirrors(), 4, 1, {one, has_cube}},
          {"rough floor", truth::mirrorFloor(0.4), 1, 512, {one, looks_up}}};
}

}  // namespace viewloom::bench
