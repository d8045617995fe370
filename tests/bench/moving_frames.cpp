// SPDX-License-Identifier: Apache-2.0
#include "bench/moving_frames.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scoring/psnr.h"
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

// Picture of a camera that looks at the body from the origin, and goes and turns with it.
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

// A px of a warp that is linear between px reads no further from the one that came there: past a
// crack of one px.
constexpr double kBesideMax_px = 1;
// Neighbours whose 1/Z differs by more than this share are not of one surface: walls and floors of
// the room have less from px to px, and its silhouettes more.
constexpr double kConnectedShare = 0.04;

// Sample that came to a px of a warp.
struct Arrival {
  double inv_z = -1;  // 1/m; below 0 = nothing
  size_t from = 0;    // px of the source
  glm::dvec2 at_px{0.0};
};

glm::dvec2 middleOf(size_t px, SizePx size_px) {
  return {double(px % size_px.width) + 0.5, double(px / size_px.width) + 0.5};
}

// The nearest sample of each px.
std::vector<Arrival> movedTo(const truth::Picture& picture, const Pose& camera) {
  const Intrinsics& lens = picture.camera.intrinsics;
  const Pose view_from_source = compose(inverse(camera), picture.camera.pose);
  std::vector<Arrival> arrivals(picture.size_px.area());
  for (size_t px = 0; px < arrivals.size(); ++px) {
    const double depth_m = picture.layers.front().depth_m[px];
    const glm::dvec2 at =
        (middleOf(px, picture.size_px) - lens.principal_px) / lens.focal_px * depth_m;
    const glm::dvec3 seen_m = view_from_source.orientation * glm::dvec3(at.x, -at.y, -depth_m) +
                              view_from_source.position_m;
    if (seen_m.z >= 0) continue;
    const glm::dvec2 to =
        lens.principal_px + lens.focal_px * glm::dvec2(seen_m.x, -seen_m.y) / -seen_m.z;
    const glm::dvec2 cell = glm::floor(to);
    if (cell.x < 0 || cell.x >= picture.size_px.width) continue;
    if (cell.y < 0 || cell.y >= picture.size_px.height) continue;
    Arrival& target = arrivals[size_t(cell.y) * picture.size_px.width + size_t(cell.x)];
    if (-1 / seen_m.z > target.inv_z) target = {-1 / seen_m.z, px, to};
  }
  return arrivals;
}

void fillAlongRows(std::vector<Arrival>& arrivals, SizePx size_px) {
  for (size_t first = 0; first < arrivals.size(); first += size_px.width) {
    const size_t end = first + size_px.width;
    for (size_t px = first; px < end; ++px) {
      if (arrivals[px].inv_z >= 0) continue;
      size_t right = px;
      while (right < end && arrivals[right].inv_z < 0) ++right;
      const bool has_left = px > first;
      if (!has_left && right == end) break;
      const bool takes_left =
          has_left && (right == end || arrivals[px - 1].inv_z <= arrivals[right].inv_z);
      const Arrival farther = arrivals[takes_left ? px - 1 : right];
      for (; px < right; ++px) arrivals[px] = farther;
    }
  }
}

// Rows to which nothing came, at the top or the bottom, are like the nearest that something came
// to.
void fillRows(std::vector<Arrival>& arrivals, SizePx size_px) {
  const auto row = [&](size_t y) { return arrivals.begin() + ptrdiff_t(y * size_px.width); };
  const auto isFilled = [&](size_t y) { return row(y)->inv_z >= 0; };
  for (size_t y = 1; y < size_px.height; ++y) {
    if (isFilled(y - 1) && !isFilled(y)) std::copy_n(row(y - 1), size_px.width, row(y));
  }
  for (size_t y = size_px.height - 1; y > 0; --y) {
    if (isFilled(y) && !isFilled(y - 1)) std::copy_n(row(y), size_px.width, row(y - 1));
  }
}

// The first layer, sRGB-encoded, between its px.
class PictureReader {
 public:
  explicit PictureReader(const truth::Picture& picture)
      : size_px_(picture.size_px),
        image_(imageOf(picture)),
        depth_m_(picture.layers.front().depth_m) {}

  // So far beside the middle of a px, bilinear. Where that is another surface's, its own colour.
  glm::dvec3 at(size_t px, const glm::dvec2& beside_px) const {
    const glm::dvec2 place = glm::clamp(middleOf(px, size_px_) - 0.5 + beside_px, glm::dvec2(0),
                                        glm::dvec2(size_px_.width - 1, size_px_.height - 1));
    const glm::dvec2 low = glm::floor(place);
    const glm::dvec2 part = place - low;
    const glm::dvec2 high(std::min(low.x + 1, size_px_.width - 1.0),
                          std::min(low.y + 1, size_px_.height - 1.0));
    return glm::mix(glm::mix(near(px, low.x, low.y), near(px, high.x, low.y), part.x),
                    glm::mix(near(px, low.x, high.y), near(px, high.x, high.y), part.x), part.y);
  }

 private:
  glm::dvec3 near(size_t px, double x, double y) const {
    const size_t other = size_t(y) * size_px_.width + size_t(x);
    const double apart = std::abs(double{depth_m_[px]} / double{depth_m_[other]} - 1);
    const size_t from = apart <= kConnectedShare ? other : px;
    return {image_.rgb[3 * from], image_.rgb[3 * from + 1], image_.rgb[3 * from + 2]};
  }

  const SizePx size_px_;
  const ScoredImage image_;
  const std::vector<float>& depth_m_;
};

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

ScoredImage rowWarp(const truth::Picture& picture, const Pose& camera, WarpedColor color) {
  std::vector<Arrival> arrivals = movedTo(picture, camera);
  fillAlongRows(arrivals, picture.size_px);
  fillRows(arrivals, picture.size_px);
  const PictureReader reader(picture);
  ScoredImage warped{.size_px = picture.size_px, .rgb = {}};
  warped.rgb.reserve(3 * arrivals.size());
  for (size_t px = 0; px < arrivals.size(); ++px) {
    const Arrival& arrival = arrivals[px];
    glm::dvec2 beside_px(0);
    if (color == WarpedColor::kBetweenPx) {
      beside_px =
          glm::clamp(middleOf(px, picture.size_px) - arrival.at_px, -kBesideMax_px, kBesideMax_px);
    }
    const glm::dvec3 light = reader.at(arrival.from, beside_px);
    for (int c = 0; c < 3; ++c) warped.rgb.push_back(float(light[c]));
  }
  return warped;
}

double psnrDb(const ScoredImage& got, const ScoredImage& truth) {
  Psnr psnr;
  for (size_t i = 0; i < truth.rgb.size(); ++i) {
    psnr.add(double{got.rgb[i]} - double{truth.rgb[i]});
  }
  return psnr.db();
}

}  // namespace viewloom::bench
