// SPDX-License-Identifier: Apache-2.0
#include "mp4/movie_coder.h"

#include <gtest/gtest.h>

#include <functional>
#include <optional>

#include "mp4/avc_track.h"
#include "unit/video/planned_encoder.h"
#include "video/annex_b.h"
#include "video/openh264_decoder.h"

namespace viewloom::test::movie_coder_test {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr AtlasTiles kAtlas = {.atlas_px = {64, 48}, .tile_px = {32, 24}, .columns = 2, .rows = 2};

bool isSync(std::span<const uint8_t> access_unit) {
  for (const NalUnit& unit : nalUnits(access_unit)) {
    if (unit.type() == NalType::kIdrSlice) return true;
  }
  return false;
}

TEST(MovieCoder, beginsAnewEveryTwoSeconds) {
  const auto coder = MovieCoder::make({.atlas = kAtlas, .video = *fitVideoTiles(kAtlas)});
  ASSERT_TRUE(coder.ok()) << coder.status();
  const auto decoder = *OpenH264Decoder::make();
  const std::vector<uint8_t> rgb(64 * 48 * 3, 90);
  std::vector<bool> syncs;
  for (const int64_t time_ns : {0 * kMs, 100 * kMs, 1999 * kMs, 2000 * kMs, 2100 * kMs}) {
    const auto unit = (*coder)->code({.samples = rgb.data()}, time_ns);
    ASSERT_TRUE(unit.ok()) << unit.status();
    syncs.push_back(isSync(*unit));
    const auto picture = decoder->decode(*unit, {64, 48});
    ASSERT_TRUE(picture.ok()) << picture.status();
    EXPECT_NEAR(picture->y[0], 90, 1);
  }
  EXPECT_EQ(syncs, (std::vector<bool>{true, false, false, true, false}));
  const auto again = (*coder)->codeAgain(2200 * kMs);
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_LT(again->size(), 60U) << "nothing moves";
}

// A kind that fails at some of its calls, counted over all of its encoders from 0.
VideoEncoderChoicePtr failingAt(std::function<bool(int call)> fails) {
  EncoderPlan plan;
  plan.before = [calls = std::make_shared<int>(0), fails = std::move(fails)](int) {
    return fails((*calls)++) ? absl::InternalError("the device is lost") : absl::OkStatus();
  };
  return std::make_shared<const VideoEncoderChoice>(plannedKind("planned", plan),
                                                    std::vector<EncoderProbe>());
}

class FailingMovie {
 public:
  explicit FailingMovie(VideoEncoderChoicePtr encoders)
      : coder_(*MovieCoder::make(
            {.atlas = kAtlas, .video = *fitVideoTiles(kAtlas), .encoders = std::move(encoders)})) {}

  // Whether the next picture refers to no other; it decodes after those before, with their sets.
  absl::StatusOr<bool> next(int64_t time_ns) {
    const auto unit = coder_->code({.samples = rgb_.data()}, time_ns);
    VIEWLOOM_RETURN_IF_ERROR(unit.status());
    if (!track_) track_ = *readAvcTrack(*unit);
    VIEWLOOM_RETURN_IF_ERROR(makeAvcSample(*unit, track_->sets).status());
    VIEWLOOM_RETURN_IF_ERROR(decoder_->decode(*unit, {64, 48}).status());
    return isSync(*unit);
  }

 private:
  const std::unique_ptr<MovieCoder> coder_;
  const std::unique_ptr<OpenH264Decoder> decoder_ = *OpenH264Decoder::make();
  const std::vector<uint8_t> rgb_ = std::vector<uint8_t>(64 * 48 * 3, 90);
  std::optional<AvcTrack> track_;
};

TEST(MovieCoder, startsAnEncoderAgainThatFails) {
  FailingMovie movie(failingAt([](int call) { return call == 2 || call == 6; }));
  std::vector<bool> syncs;
  for (const int64_t time_ms : {0, 100, 1900, 2100, 3800, 3950, 4000}) {
    const auto is_sync = movie.next(time_ms * kMs);
    ASSERT_TRUE(is_sync.ok()) << time_ms << ": " << is_sync.status();
    syncs.push_back(*is_sync);
  }
  // The third and the sixth picture are those at which it fails; two seconds count from there.
  EXPECT_EQ(syncs, (std::vector<bool>{true, false, true, false, false, true, false}));
}

TEST(MovieCoder, endsWhereANewEncoderFailsToo) {
  const VideoEncoderChoicePtr encoders = failingAt([](int call) { return call >= 2; });
  FailingMovie movie(encoders);
  ASSERT_TRUE(movie.next(0).ok());
  ASSERT_TRUE(movie.next(100 * kMs).ok());
  for (const int64_t time_ms : {200, 5000}) {
    const absl::Status ended = movie.next(time_ms * kMs).status();
    EXPECT_EQ(ended.code(), absl::StatusCode::kInternal);
    EXPECT_EQ(ended.message(), "the video encoder planned has failed twice: the device is lost");
  }
  const auto next = encoders->begin({.size_px = {64, 48}});
  EXPECT_EQ(next->kind.name, kOpenH264Name) << "for what comes";
}

TEST(MovieCoder, endsWhereAnEncoderFailsAgainSoon) {
  FailingMovie movie(failingAt([](int call) { return call == 1 || call == 4; }));
  ASSERT_TRUE(movie.next(0).ok());
  ASSERT_TRUE(movie.next(100 * kMs).ok()) << "by a new encoder";
  ASSERT_TRUE(movie.next(200 * kMs).ok());
  EXPECT_FALSE(movie.next(2000 * kMs).ok());
}

TEST(MovieCoder, takesOpenH264WhereTheFirstPictureFails) {
  FailingMovie movie(failingAt([](int) { return true; }));
  for (const int64_t time_ms : {0, 100, 200}) {
    const auto is_sync = movie.next(time_ms * kMs);
    ASSERT_TRUE(is_sync.ok()) << is_sync.status();
    EXPECT_EQ(*is_sync, time_ms == 0);
  }
}

}  // namespace
}  // namespace viewloom::test::movie_coder_test
