// SPDX-License-Identifier: Apache-2.0
#include "encode/video_encoders.h"

#include <gtest/gtest.h>

#include <utility>

#include "base/idle_memory.h"
#include "display/video_stack.h"

namespace viewloom::test::video_encoders_test {
namespace {

constexpr SizePx kSize_px = {64, 64};

std::unique_ptr<VideoEncoder> taken(VideoEncoders& encoders, uint32_t qp) {
  auto encoder = encoders.take(kSize_px, qp);
  EXPECT_TRUE(encoder.ok()) << encoder.status();
  return encoder.ok() ? *std::move(encoder) : nullptr;
}

TEST(VideoEncoders, serveTheNextAtlasOfTheSameFormat) {
  VideoEncoders encoders(1);
  std::unique_ptr<VideoEncoder> encoder = taken(encoders, 24);
  const VideoEncoder* const first = encoder.get();
  encoders.putBack(std::move(encoder));
  EXPECT_NE(taken(encoders, 30).get(), first) << "another quantisation";
  EXPECT_EQ(taken(encoders, 24).get(), first);
}

TEST(VideoEncoders, cutNoPictureIntoSlicesOfAFewRows) {
  VideoEncoders encoders(4);
  EXPECT_EQ(taken(encoders, 24)->format().thread_count, 1u);
  EXPECT_EQ(taken(encoders, 24)->format().slice_count, 1u);
}

// The threads of the library do not check what noise takes.
TEST(VideoEncoders, codeFineVideoOnOneThread) {
  VideoEncoders encoders(2);
  EXPECT_EQ(encoders.take({64, 128}, kThreadedQpMin)->get()->format().thread_count, 2u);
  EXPECT_EQ(encoders.take({64, 128}, kThreadedQpMin - 1)->get()->format().thread_count, 1u);
}

TEST(VideoEncoders, changeTheirThreadsWithTheQuantisation) {
  VideoEncoders encoders(2);
  auto encoder = encoders.take({64, 128}, 30);
  ASSERT_TRUE(encoder.ok()) << encoder.status();
  const VideoEncoder* const first = encoder->get();
  const auto set = [&](uint32_t qp) {
    const absl::StatusOr<bool> is_other = encoders.setQp(*encoder, qp);
    EXPECT_TRUE(is_other.ok()) << is_other.status();
    EXPECT_EQ((*encoder)->format().qp, qp);
    return is_other.ok() && *is_other;
  };
  EXPECT_FALSE(set(kVideoQpMax));
  EXPECT_FALSE(set(kThreadedQpMin));
  EXPECT_EQ(encoder->get(), first);
  EXPECT_TRUE(set(kVideoQpMin));
  EXPECT_EQ((*encoder)->format().thread_count, 1u);
  EXPECT_FALSE(set(kThreadedQpMin - 1));
  EXPECT_TRUE(set(kThreadedQpMin));
  EXPECT_EQ(encoder->get(), first) << "it has waited";
  EXPECT_EQ(encoders.setQp(*encoder, kVideoQpMax + 1).status().code(),
            absl::StatusCode::kInvalidArgument);
}

TEST(VideoEncoders, letIdleMemoryGo) {
  VideoEncoders encoders(1);
  EXPECT_EQ(encoders.idleMemory()->idleBytes(), 0u);
  encoders.putBack(taken(encoders, 24));
  EXPECT_EQ(encoders.idleMemory()->idleBytes(), videoEncoderBytes(kSize_px));
  EXPECT_EQ(encoders.idleMemory()->releaseIdle(std::chrono::hours(1)), 0u);
  EXPECT_EQ(encoders.idleMemory()->releaseIdle({}), videoEncoderBytes(kSize_px));
  EXPECT_EQ(encoders.idleMemory()->idleBytes(), 0u);
}

TEST(VideoEncoders, keepTheNewestFew) {
  VideoEncoders encoders(1);
  for (uint32_t qp = 20; qp < 30; ++qp) encoders.putBack(taken(encoders, qp));
  EXPECT_EQ(encoders.idleMemory()->idleBytes(), 4 * videoEncoderBytes(kSize_px));
}

}  // namespace
}  // namespace viewloom::test::video_encoders_test
