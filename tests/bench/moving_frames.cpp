// SPDX-License-Identifier: Apache-2.0
#include "bench/moving_frames.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "support/srgb_transfer.h"
#include "support/truth/picture_frame.h"
#include "support/truth/scenes.h"

namespace viewloom::bench {
namespace {

// Sways, leans forward and looks around, twice as fast as anybody would: it speeds up and slows
// down all the time.
Pose handheld(double time_s) {
  const auto wave = [&](double rate_hz, double phase) {
    return std::sin(2 * std::numbers::pi * (rate_hz * time_s + phase));
  };
  return {.position_m = {0.20 * wave(0.7, 0), 0.06 * wave(0.9, 0.2), 0.12 * wave(0.5, 0.1) - 0.1},
          .orientation = glm::dquat(
              glm::dvec3(0.03 * wave(0.8, 0.3), 0.08 * wave(0.6, 0.05), 0.02 * wave(0.7, 0.5)))};
}

bool moves(const truth::Body& body) {
  return body.velocity_mps != glm::dvec3(0) || body.spin_rad_per_s != glm::dvec3(0);
}

// Of a camera that looks at the body from the origin, and goes and turns with it.
truth::Picture pictureBeside(const truth::Body& body, double time_s, uint32_t layer_count) {
  constexpr SizePx kThing_px{160, 160};
  constexpr double kThingFocal_px = 600;  // 15 degrees
  const Pose at_first{
      .orientation = glm::quatLookAt(glm::normalize(body.pose.position_m), glm::dvec3(0, 1, 0))};
  const Pose gone = compose(body.poseAt(time_s), inverse(body.pose));
  truth::Scene alone;
  alone.add(body);
  truth::Picture picture =
      takePicture(truth::Instant(alone, time_s),
                  {.pose = compose(gone, at_first),
                   .intrinsics = {.focal_px = glm::dvec2(kThingFocal_px),
                                  .principal_px = {0.5 * kThing_px.width, 0.5 * kThing_px.height}}},
                  {.size_px = kThing_px, .layer_count = layer_count});
  // The camera says it.
  for (truth::PictureLayer& layer : picture.layers) {
    std::fill(layer.motion_mps.begin(), layer.motion_mps.end(), glm::vec3(0));
  }
  return picture;
}

}  // namespace

Sequence movingCamera() {
  Sequence sequence{
      .name = "camera motion", .scene = truth::clutteredRoom(), .camera_at = handheld};
  for (truth::Body& body : sequence.scene.bodies) {
    body.velocity_mps = {};
    body.spin_rad_per_s = {};
  }
  return sequence;
}

Sequence movingThings() {
  return {.name = "object motion", .scene = truth::clutteredRoom(), .camera_at = [](double) {
            return Pose{};
          }};
}

Sequence fastThings() {
  constexpr double kFaster = 2;  // as the camera's hand is than any
  Sequence sequence = movingThings();
  sequence.name = "fast object motion";
  for (truth::Body& body : sequence.scene.bodies) {
    body.velocity_mps *= kFaster;
    body.spin_rad_per_s *= kFaster;
  }
  return sequence;
}

Sequence movingSources() {
  Sequence sequence = movingThings();
  sequence.name = "sources of their own";
  for (uint32_t i = 0; i < sequence.scene.bodies.size(); ++i) {
    if (moves(sequence.scene.bodies[i])) sequence.things.push_back(i);
  }
  return sequence;
}

Intrinsics sequenceIntrinsics() {
  return {.focal_px = glm::dvec2(280),
          .principal_px = {0.5 * kSequence_px.width, 0.5 * kSequence_px.height}};
}

truth::Picture pictureOf(const Sequence& sequence, uint32_t index, uint32_t layer_count) {
  const double time_s = index / kSequenceRate_hz;
  return takePicture(truth::Instant(sequence.scene, time_s),
                     {.pose = sequence.camera_at(time_s), .intrinsics = sequenceIntrinsics()},
                     {.size_px = kSequence_px, .layer_count = layer_count});
}

FramePtr frameOf(const Sequence& sequence, const truth::Picture& picture, uint32_t index,
                 uint32_t layer_count) {
  if (sequence.things.empty()) return truth::frameOf(picture, layer_count);
  const double time_s = index / kSequenceRate_hz;
  Sequence room = sequence;
  std::erase_if(room.scene.bodies, moves);
  std::vector<truth::Picture> pictures{pictureOf(room, index, layer_count)};
  for (const uint32_t thing : sequence.things) {
    pictures.push_back(pictureBeside(sequence.scene.bodies[thing], time_s, layer_count));
  }
  return truth::frameOf(pictures, layer_count);
}

ScoredImage imageOf(const truth::Picture& picture) {
  ScoredImage image{.size_px = picture.size_px, .rgb = {}};
  for (const glm::vec3& color : picture.layers.front().color) {
    for (int c = 0; c < 3; ++c) image.rgb.push_back(float(srgbFrom(double{color[c]})));
  }
  return image;
}

ScoredImage rowWarp(const truth::Picture& picture, const Pose& camera) {
  const truth::PictureLayer& layer = picture.layers.front();
  const ScoredImage source = imageOf(picture);
  const Intrinsics& lens = picture.camera.intrinsics;
  const Pose view_from_source = compose(inverse(camera), picture.camera.pose);
  ScoredImage warped{.size_px = picture.size_px, .rgb = std::vector<float>(source.rgb.size())};
  std::vector<double> nearest(picture.size_px.area(), -1);  // 1/m; below 0 = a hole
  const int width = int(picture.size_px.width);
  const int height = int(picture.size_px.height);
  for (int px = 0; px < width * height; ++px) {
    const double depth_m = layer.depth_m[size_t(px)];
    const glm::dvec2 at =
        (glm::dvec2(px % width, px / width) + 0.5 - lens.principal_px) / lens.focal_px * depth_m;
    const glm::dvec3 seen_m = view_from_source.orientation * glm::dvec3(at.x, -at.y, -depth_m) +
                              view_from_source.position_m;
    if (seen_m.z >= 0) continue;
    const glm::dvec2 to =
        lens.principal_px + lens.focal_px * glm::dvec2(seen_m.x, -seen_m.y) / -seen_m.z;
    const int x = int(std::floor(to.x)), y = int(std::floor(to.y));
    if (x < 0 || x >= width || y < 0 || y >= height) continue;
    const auto target = size_t(y * width + x);
    if (-1 / seen_m.z <= nearest[target]) continue;
    nearest[target] = -1 / seen_m.z;
    for (size_t c = 0; c < 3; ++c) warped.rgb[3 * target + c] = source.rgb[3 * size_t(px) + c];
  }
  for (size_t row = 0; row < size_t(height); ++row) {
    const size_t first = row * size_t(width), end = first + size_t(width);
    for (size_t px = first; px < end; ++px) {
      if (nearest[px] >= 0) continue;
      size_t right = px;
      while (right < end && nearest[right] < 0) ++right;
      const bool has_left = px > first;
      if (!has_left && right == end) break;
      const bool takes_left = has_left && (right == end || nearest[px - 1] <= nearest[right]);
      const size_t from = takes_left ? px - 1 : right;
      for (; px < right; ++px) {
        for (size_t c = 0; c < 3; ++c) warped.rgb[3 * px + c] = warped.rgb[3 * from + c];
      }
    }
  }
  return warped;
}

double psnrDb(const ScoredImage& got, const ScoredImage& truth) {
  double sum = 0;
  for (size_t i = 0; i < truth.rgb.size(); ++i) {
    const double difference = double{got.rgb[i]} - double{truth.rgb[i]};
    sum += difference * difference;
  }
  return -10 * std::log10(sum / double(truth.rgb.size()));
}

}  // namespace viewloom::bench
