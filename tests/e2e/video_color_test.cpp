// SPDX-License-Identifier: Apache-2.0
// Colour that the client sends as video, against what was offered.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "e2e/frame_round_trip.h"
#include "synthetic/synthetic_wire_frame.h"

namespace viewloom::video_color_test {
namespace {

using test::Arrived;

constexpr SizePx kSize_px{321, 181};

Arrived sendAsVideo(WireFrame frame, bool predicts_depth) {
  PublisherOptions options;
  options.predicts_depth = predicts_depth;
  options.color_video = ColorVideo{};
  return test::sendFrame(std::move(frame), options);
}

TEST(VideoColor, reachesTheServerWithSmallErrors) {
  constexpr size_t kLayers = 3;
  const WireFrame frame =
      syntheticWireFrame({.size_px = kSize_px, .layer_count = kLayers, .camera = {}}, 1);
  const Arrived arrived = sendAsVideo(frame, true);
  ASSERT_NE(arrived.frame, nullptr) << arrived.report.reason();
  size_t wire_bytes = 0;
  double squares = 0, count = 0;
  std::array<double, 3> sums{};
  for (size_t l = 0; l < kLayers; ++l) {
    const PlaneFormat& declared = arrived.frame->format.sources.at(0).layers.at(l).color;
    ASSERT_EQ(declared.encoding, PlaneEncoding::kH264);
    wire_bytes += declared.wire_bytes;
    const LayerPlanes& planes = arrived.frame->sources[0].at(l);
    EXPECT_EQ(planes.color_encoding, PlaneEncoding::kRgba8);
    const std::vector<uint8_t>& got = *planes.color;
    const std::vector<uint8_t>& offered = *frame.planes.at(2 * l);
    ASSERT_EQ(got.size(), offered.size());
    for (size_t i = 0; i < kSize_px.area(); ++i) {
      float depth_m = 0;
      std::memcpy(&depth_m, frame.planes[2 * l + 1]->data() + i * sizeof(depth_m), sizeof(depth_m));
      if (depth_m == 0) continue;  // no surface: its colour is not kept
      for (size_t c = 0; c < 3; ++c) {
        const double error = double{1} * got[4 * i + c] - offered[4 * i + c];
        squares += error * error;
        sums[c] += error;
      }
      count += 1;
    }
  }
  EXPECT_GT(10 * std::log10(255 * 255 * 3 * count / squares), 28) << "dB, of RGB with half chroma";
  for (const double sum : sums) EXPECT_LT(std::abs(sum / count), 1);
  EXPECT_LT(wire_bytes, kLayers * kSize_px.area() * 4 / 10);
}

// The same bytes again are the same frame.
TEST(VideoColor, isTheSameForTheSameFrame) {
  const WireFrame frame =
      syntheticWireFrame({.size_px = kSize_px, .layer_count = 1, .camera = {}}, 1);
  const Arrived once = sendAsVideo(frame, false);
  const Arrived again = sendAsVideo(frame, false);
  ASSERT_NE(once.frame, nullptr);
  ASSERT_NE(again.frame, nullptr);
  EXPECT_EQ(*once.sent.frame.planes.at(0), *again.sent.frame.planes.at(0));
  EXPECT_EQ(*once.frame->sources[0][0].color, *again.frame->sources[0][0].color);
}

}  // namespace
}  // namespace viewloom::video_color_test
