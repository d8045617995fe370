// SPDX-License-Identifier: Apache-2.0
// Views as chained H.264 from a whole server, decoded atlas by atlas.
#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/str_cat.h"
#include "e2e/picture_psnr.h"
#include "e2e/published_stream_fixture.h"
#include "e2e/wire_displays.h"
#include "lib/color_decoder.h"

namespace viewloom::test::service_chained_video_test {
namespace {

struct Decoded {
  Atlas atlas;
  absl::StatusOr<AtlasPicture> color;
};

// A client that decodes every atlas. Thread-safety: all methods may be called from any thread.
class Follower {
 public:
  Follower(const std::string& address, const v1::OpenDisplay& open)
      : watcher_(makeChannel(address), open,
                 {.on_layout = {},
                  .on_atlas =
                      [this](const Atlas& atlas) {
                        absl::StatusOr<AtlasPicture> color = decoder_.decode(atlas);
                        std::lock_guard lock(mutex_);
                        all_.push_back({atlas, std::move(color)});
                        came_.notify_all();
                      },
                  .on_connection = {}}) {}

  // The atlases so far, once there are so many.
  std::vector<Decoded> waitForCount(size_t count) {
    std::unique_lock lock(mutex_);
    if (!came_.wait_for(lock, kGiveUpAfter, [&] { return all_.size() >= count; })) {
      throw std::runtime_error(strCat(all_.size(), " atlases came of ", count));
    }
    return all_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::vector<Decoded> all_;
  ColorDecoder decoder_;  // the watcher's thread's own
  Watcher watcher_;       // last: it calls
};

constexpr uint32_t kPictures = 20;  // a view each

v1::OpenDisplay chainedQuilt() {
  v1::OpenDisplay open = asVideo(smallQuilt(), 20);
  open.set_count(0);
  open.mutable_encoding()->set_prediction(v1::PREDICTION_ACROSS_ATLASES);
  return open;
}

using ServiceChainedVideoTest = PublishedStreamFixture;

TEST_F(ServiceChainedVideoTest, refersToTheAtlasBeforeAndShowsEachFrame) {
  Follower follower(service_->grpcAddress(), chainedQuilt());
  for (size_t number = 1; number <= 4; ++number) {
    publish(0.1 * double(number));
    follower.waitForCount(number);
  }
  const std::vector<Decoded> all = follower.waitForCount(4);
  uint64_t before = 0;
  for (const Decoded& one : all) {
    EXPECT_EQ(one.atlas.layout->encoding().prediction(), v1::PREDICTION_ACROSS_ATLASES);
    EXPECT_EQ(one.atlas.layout->video().picture_count(), kPictures);
    EXPECT_EQ(one.atlas.header.reference_sequence(), before);
    // The first picture to come has the views of the last one before.
    EXPECT_EQ(one.atlas.header.is_backward(), before % 2 == 1);
    const uint32_t first_index = one.atlas.header.is_backward() ? kPictures - 1 : 0;
    EXPECT_EQ(one.atlas.bands.front().image_index, first_index);
    EXPECT_EQ(one.atlas.bands.back().image_index, kPictures - 1 - first_index);
    EXPECT_FALSE(one.atlas.header.discardable());
    EXPECT_TRUE(one.color.ok()) << one.color.status();
    before = one.atlas.header.sequence();
  }
  v1::OpenDisplay exact = smallQuilt();
  exact.mutable_encoding()->set_color(v1::BAND_ENCODING_ZSTD);
  const Atlas newest = atlasOf(exact);
  ASSERT_EQ(newest.header.frame_number(), all.back().atlas.header.frame_number());
  const auto color = decodePlane(newest, v1::ATLAS_PLANE_COLOR);
  ASSERT_TRUE(color.ok() && all.back().color.ok());
  EXPECT_GT(lumaPsnrDb(*all.back().color, *color), kFineLumaDb);
}

TEST_F(ServiceChainedVideoTest, givesAJoinerOfAStandingFrameAnAtlasThatNeedsNoOther) {
  Follower first(service_->grpcAddress(), chainedQuilt());
  publish(0.1);
  first.waitForCount(1);
  publish(0.2);
  const Decoded standing = first.waitForCount(2)[1];
  EXPECT_NE(standing.atlas.header.reference_sequence(), 0u);
  Follower joiner(service_->grpcAddress(), chainedQuilt());
  const Decoded got = joiner.waitForCount(1)[0];
  EXPECT_EQ(got.atlas.header.reference_sequence(), 0u);
  EXPECT_EQ(got.atlas.header.frame_number(), standing.atlas.header.frame_number());
  ASSERT_TRUE(got.color.ok() && standing.color.ok());
  EXPECT_GT(lumaPsnrDb(*got.color, *standing.color), kFineLumaDb);
  // Both follow from here on.
  publish(0.3);
  EXPECT_EQ(joiner.waitForCount(2)[1].atlas.header.reference_sequence(),
            got.atlas.header.sequence());
  for (const Decoded& one : first.waitForCount(4)) EXPECT_TRUE(one.color.ok());
}

}  // namespace
}  // namespace viewloom::test::service_chained_video_test
