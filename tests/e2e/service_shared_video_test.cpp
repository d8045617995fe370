// SPDX-License-Identifier: Apache-2.0
// Many viewers of one display as H.264, and how often the server encodes for them.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "e2e/atlas_viewer.h"
#include "e2e/published_stream_fixture.h"
#include "e2e/wire_displays.h"

namespace viewloom::test::service_shared_video_test {
namespace {

constexpr size_t kViewerCount = 8;
constexpr uint64_t kFrameCount = 4;
// Given alone, they do not change, and there is no second rung.
constexpr uint32_t kQp = 24;
constexpr uint32_t kOtherQp = 32;

Atlas numbered(AtlasViewer& viewer, uint64_t sequence) {
  return viewer.waitFor([&](const Atlas& atlas) { return atlas.header.sequence() == sequence; });
}

std::string bytesOf(const Atlas& atlas) {
  std::string bytes;
  for (const AtlasBand& band : atlas.bands) bytes.append(band.bytes.begin(), band.bytes.end());
  return bytes;
}

class ServiceSharedVideoTest : public PublishedStreamFixture,
                               public testing::WithParamInterface<v1::Prediction> {
 protected:
  static v1::OpenDisplay video(uint32_t qp) {
    v1::OpenDisplay open = asVideo(smallQuilt(), qp);
    open.set_count(0);
    open.mutable_encoding()->set_prediction(GetParam());
    return open;
  }

  // Encoded atlases, once there are so many: they are counted after they were sent.
  double encodedCount(uint64_t expected) const {
    const Counter& encoded = service_->metrics().atlases_encoded;
    const auto end = std::chrono::steady_clock::now() + kGiveUpAfter;
    while (encoded.value() < double(expected) && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return encoded.value();
  }
};

TEST_P(ServiceSharedVideoTest, codesEachAtlasOnceForEightViewers) {
  std::vector<std::unique_ptr<AtlasViewer>> viewers;
  for (size_t i = 0; i < kViewerCount; ++i) {
    viewers.push_back(std::make_unique<AtlasViewer>(service_->grpcAddress(), video(kQp)));
  }
  const Metrics& metrics = service_->metrics();
  uint64_t atlas_bytes = 0;
  uint64_t picture_count = 0;
  for (uint64_t sequence = 1; sequence <= kFrameCount; ++sequence) {
    publish(0.1 * double(sequence));
    const Atlas first = numbered(*viewers.front(), sequence);
    const bool is_chained = GetParam() == v1::PREDICTION_ACROSS_ATLASES;
    EXPECT_EQ(first.header.reference_sequence(), is_chained ? sequence - 1 : 0);
    const std::string bytes = bytesOf(first);
    for (const auto& viewer : viewers) EXPECT_EQ(bytesOf(numbered(*viewer, sequence)), bytes);
    atlas_bytes += bytes.size();
    picture_count += first.layout->video().picture_count();
  }
  EXPECT_EQ(metrics.video_pictures.value(), double(picture_count));
  EXPECT_EQ(metrics.encoded_bytes.value(), double(atlas_bytes));
  EXPECT_EQ(encodedCount(kFrameCount), double(kFrameCount));

  // A viewer that asks for another quantisation costs an encoding: the counters can tell.
  const Atlas other = atlasOf(video(kOtherQp));
  EXPECT_EQ(metrics.video_pictures.value(),
            double(picture_count + other.layout->video().picture_count()));
  EXPECT_EQ(encodedCount(kFrameCount + 1), double(kFrameCount + 1));
}

INSTANTIATE_TEST_SUITE_P(Predictions, ServiceSharedVideoTest,
                         testing::Values(v1::PREDICTION_WITHIN_ATLAS,
                                         v1::PREDICTION_ACROSS_ATLASES));

}  // namespace
}  // namespace viewloom::test::service_shared_video_test
