// SPDX-License-Identifier: Apache-2.0
#include "frame/same_content.h"

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace viewloom::test::same_content_test {
namespace {

constexpr SizePx kSizePx{4, 3};

SharedBytes bytes(uint8_t first) {
  std::vector<uint8_t> samples(kSizePx.area() * 4);
  for (size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<uint8_t>(first + i);
  return std::make_shared<const std::vector<uint8_t>>(std::move(samples));
}

// Two sources of two layers, of which the last mirrors. Planes of two such frames are equal and lie
// apart.
Frame frame() {
  Frame made;
  for (uint8_t s = 0; s < 2; ++s) {
    SourceFormat& source = made.format.sources.emplace_back();
    std::vector<LayerPlanes>& planes = made.sources.emplace_back();
    for (uint8_t l = 0; l < 2; ++l) {
      LayerFormat& layer = source.layers.emplace_back();
      layer.color.size_px = kSizePx;
      layer.depth = {
          .kind = PlaneKind::kDepth, .encoding = PlaneEncoding::kDepthF32, .size_px = kSizePx};
      planes.push_back({.color = bytes(static_cast<uint8_t>(10 * s + l)),
                        .depth = bytes(static_cast<uint8_t>(100 + 10 * s + l))});
    }
    source.layers.back().others = {{.kind = PlaneKind::kSpecular, .size_px = kSizePx, .depth = {}}};
    planes.back().surface = bytes(static_cast<uint8_t>(200 + s));
    planes.back().motion = bytes(static_cast<uint8_t>(50 + s));
  }
  return made;
}

SharedBytes withLastByteChanged(const SharedBytes& plane) {
  std::vector<uint8_t> changed = *plane;
  changed.back() ^= 1;
  return std::make_shared<const std::vector<uint8_t>>(std::move(changed));
}

using Change = std::pair<std::string, std::function<void(Frame&)>>;

TEST(SameContent, isThereWhateverTheNumberTheTimesAndTheWay) {
  const std::vector<Change> changes = {
      {"nothing", [](Frame&) {}},
      {"number", [](Frame& f) { f.format.number = 9; }},
      {"capture time", [](Frame& f) { f.format.capture_time_ns = 9; }},
      {"arrival", [](Frame& f) { f.times.decoded_ns = 9; }},
      {"order of planes", [](Frame& f) { f.format.sources[0].layers[0].depth_first = true; }},
      {"stride", [](Frame& f) { f.format.sources[0].layers[0].color.stride_bytes = 64; }},
      {"bytes on the wire", [](Frame& f) { f.format.sources[1].layers[1].depth.wire_bytes = 7; }},
      {"compression",
       [](Frame& f) { f.format.sources[0].layers[1].depth.compression = PlaneCompression::kZstd; }},
      {"JPEG that decodes to the same",
       [](Frame& f) { f.format.sources[0].layers[1].color.encoding = PlaneEncoding::kJpeg; }},
  };
  const Frame standing = frame();
  for (const auto& [what, change] : changes) {
    Frame other = frame();
    change(other);
    EXPECT_TRUE(haveSameContent(standing, other)) << what;
    EXPECT_TRUE(haveSameContent(other, standing)) << what;
  }
}

TEST(SameContent, endsWithAnyDifference) {
  const std::vector<Change> changes = {
      {"exposure", [](Frame& f) { f.format.exposure_ev = 1; }},
      {"tone map", [](Frame& f) { f.format.tone_map = ToneMap::kAgx; }},
      {"a source less",
       [](Frame& f) {
         f.format.sources.pop_back();
         f.sources.pop_back();
       }},
      {"a layer less",
       [](Frame& f) {
         f.format.sources[1].layers.pop_back();
         f.sources[1].pop_back();
       }},
      {"pose", [](Frame& f) { f.format.sources[1].camera.pose.position_m.z = 1e-9; }},
      {"focal length", [](Frame& f) { f.format.sources[0].camera.intrinsics.focal_px.x = 2; }},
      {"tolerance", [](Frame& f) { f.format.sources[0].connection_tolerance = 0.1; }},
      {"cube map", [](Frame& f) { f.format.sources[0].is_cube_map = true; }},
      {"transfer",
       [](Frame& f) { f.format.sources[0].layers[0].color.transfer = ColorTransfer::kLinear; }},
      {"primaries",
       [](Frame& f) { f.format.sources[0].layers[0].color.primaries = ColorPrimaries::kBt2020; }},
      {"alpha", [](Frame& f) { f.format.sources[0].layers[0].color.alpha = AlphaMode::kStraight; }},
      {"size",
       [](Frame& f) {
         f.format.sources[1].layers[0].depth.size_px = {3, 4};
       }},
      {"depth encoding",
       [](Frame& f) { f.format.sources[1].layers[0].depth.encoding = PlaneEncoding::kDepthF16; }},
      {"meaning of depth",
       [](Frame& f) {
         f.format.sources[1].layers[0].depth.depth.meaning = DepthMeaning::kDisparity;
       }},
      {"scale of depth", [](Frame& f) { f.format.sources[1].layers[0].depth.depth.scale = 2; }},
      {"invalid depth",
       [](Frame& f) { f.format.sources[1].layers[0].depth.depth.invalid_value = 0; }},
      {"colour",
       [](Frame& f) { f.sources[1][1].color = withLastByteChanged(f.sources[1][1].color); }},
      {"depth",
       [](Frame& f) { f.sources[1][1].depth = withLastByteChanged(f.sources[1][1].depth); }},
      {"how it mirrors",
       [](Frame& f) { f.sources[1][1].surface = withLastByteChanged(f.sources[1][1].surface); }},
      {"how it moves",
       [](Frame& f) { f.sources[1][1].motion = withLastByteChanged(f.sources[1][1].motion); }},
      {"a motion less", [](Frame& f) { f.sources[0][1].motion = nullptr; }},
      {"a mirror less",
       [](Frame& f) {
         f.format.sources[1].layers[1].color_has_reflections = true;
         f.sources[1][1].surface = nullptr;
       }},
  };
  const Frame standing = frame();
  for (const auto& [what, change] : changes) {
    Frame other = frame();
    change(other);
    EXPECT_FALSE(haveSameContent(standing, other)) << what;
    EXPECT_FALSE(haveSameContent(other, standing)) << what;
  }
}

}  // namespace
}  // namespace viewloom::test::same_content_test
