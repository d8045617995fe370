// SPDX-License-Identifier: Apache-2.0
#include "cli/replayed_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "unit/client/test_files.h"

namespace viewloom::cli::replayed_frames_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr int64_t kMs = 1'000'000;
constexpr int64_t kStart_ns = 1'700'000'000'000'000'000;

WireFrame makeFrame(uint64_t number, int64_t capture_time_ns) {
  WireFrame frame;
  frame.header.set_number(number);
  frame.header.set_capture_time_ns(capture_time_ns);
  frame.header.add_sources()->add_layers()->add_planes()->set_bytes_count(3);
  frame.planes.push_back(std::make_shared<const std::vector<uint8_t>>(3, uint8_t(number)));
  return frame;
}

class ReplayedFramesTest : public testing::Test {
 protected:
  ReplayedFramesTest() {
    // Sent at 0, 30 and 100 ms; captured at 7000, 7040 and 7100 ms.
    ManualClock clock;
    const auto recorder = FrameRecorder::create(file_, clock);
    EXPECT_EQ((*recorder)->add(makeFrame(5, 7000 * kMs)), absl::OkStatus());
    clock.advance(30 * kMs);
    EXPECT_EQ((*recorder)->add(makeFrame(6, 7040 * kMs)), absl::OkStatus());
    clock.advance(70 * kMs);
    EXPECT_EQ((*recorder)->add(makeFrame(9, 7100 * kMs)), absl::OkStatus());
    EXPECT_EQ((*recorder)->complete(), absl::OkStatus());
  }

  static std::unique_ptr<ReplayedFrames> open(const ReplayOptions& options) {
    auto frames = ReplayedFrames::open(options, [] { return kStart_ns; });
    EXPECT_TRUE(frames.ok()) << frames.status();
    return *std::move(frames);
  }

  struct Played {
    std::vector<int> planes;          // their first bytes
    std::vector<double> due_ms;       // of all but the first
    std::vector<int64_t> capture_ms;  // since the start
  };

  static Played play(ReplayedFrames& frames, size_t count_max) {
    Played played;
    while (played.planes.size() < count_max) {
      if (!played.planes.empty()) played.due_ms.push_back(1e3 * frames.nextDue_s().value_or(-1));
      const auto frame = frames.next(0);
      EXPECT_TRUE(frame.ok()) << frame.status();
      if (!frame.ok() || !frame->has_value()) break;
      played.planes.push_back((**frame).planes.at(0)->at(0));
      played.capture_ms.push_back(((**frame).header.capture_time_ns() - kStart_ns) / kMs);
    }
    return played;
  }

  files::TestFolder folder_;
  const fs::path file_ = folder_.path() / "frames.vlr";
};

TEST_F(ReplayedFramesTest, keepsTheTimesOfSendingAndCapture) {
  const auto frames = open({.file = file_});
  const Played played = play(*frames, 10);
  EXPECT_THAT(played.planes, ElementsAre(5, 6, 9));
  EXPECT_THAT(played.due_ms, ElementsAre(DoubleNear(30, 1e-6), DoubleNear(100, 1e-6), -1000));
  EXPECT_THAT(played.capture_ms, ElementsAre(0, 40, 100));
  EXPECT_THAT(frames->takeNotes(), ElementsAre());
}

TEST_F(ReplayedFramesTest, playsAtAnotherSpeed) {
  const auto frames = open({.file = file_, .speed = 0.5});
  const Played played = play(*frames, 3);
  EXPECT_THAT(played.due_ms, ElementsAre(DoubleNear(60, 1e-6), DoubleNear(200, 1e-6)));
  EXPECT_THAT(played.capture_ms, ElementsAre(0, 80, 200));
}

TEST_F(ReplayedFramesTest, playsAtARateOfItsOwn) {
  const auto frames = open({.file = file_, .rate_hz = 4});
  const Played played = play(*frames, 3);
  EXPECT_THAT(played.due_ms, ElementsAre(-1000, -1000)) << "the command's rate decides";
  EXPECT_THAT(played.capture_ms, ElementsAre(0, 250, 500));
}

TEST_F(ReplayedFramesTest, goesRoundAndRound) {
  const auto frames = open({.file = file_, .is_looping = true});
  const Played played = play(*frames, 7);
  EXPECT_THAT(played.planes, ElementsAre(5, 6, 9, 5, 6, 9, 5));
  // 100 ms between three frames: a round lasts 150 ms.
  const std::vector<double> due_ms = {30, 100, 150, 180, 250, 300};
  EXPECT_THAT(played.due_ms, testing::Pointwise(DoubleNear(1e-6), due_ms));
  EXPECT_THAT(played.capture_ms, ElementsAre(0, 40, 100, 150, 190, 250, 300));
}

TEST_F(ReplayedFramesTest, goesRoundWithOneFrame) {
  const fs::path lone = folder_.path() / "lone.vlr";
  const SteadyClock clock;
  const auto recorder = FrameRecorder::create(lone, clock);
  ASSERT_EQ((*recorder)->add(makeFrame(3, 0)), absl::OkStatus());
  ASSERT_EQ((*recorder)->complete(), absl::OkStatus());
  const auto frames = open({.file = lone, .is_looping = true});
  const Played played = play(*frames, 3);
  EXPECT_THAT(played.planes, ElementsAre(3, 3, 3));
  EXPECT_THAT(played.due_ms, ElementsAre(DoubleNear(1e3 / 15, 1e-6), DoubleNear(2e3 / 15, 1e-6)));
}

TEST_F(ReplayedFramesTest, saysOnceThatARecordingIsCutShort) {
  const fs::path part = folder_.truncated(file_, fs::file_size(file_) - 20);
  const auto frames = open({.file = part, .is_looping = true});
  EXPECT_THAT(play(*frames, 4).planes, ElementsAre(5, 6, 5, 6));
  EXPECT_THAT(
      frames->takeNotes(),
      ElementsAre(part.string() + ": ends before it is complete; replayed 2 complete frames"));
  EXPECT_THAT(frames->takeNotes(), ElementsAre());
}

TEST_F(ReplayedFramesTest, refusesWhatHoldsNoFrame) {
  const fs::path part = folder_.truncated(file_, 30);
  const auto frames = ReplayedFrames::open({.file = part});
  EXPECT_THAT(std::string(frames.status().message()), HasSubstr("contains no complete frame"));
}

TEST_F(ReplayedFramesTest, takesCaptureTimesOfAnyClock) {
  const fs::path wild = folder_.path() / "wild.vlr";
  const SteadyClock clock;
  const auto recorder = FrameRecorder::create(wild, clock);
  ASSERT_EQ((*recorder)->add(makeFrame(1, INT64_MIN)), absl::OkStatus());
  ASSERT_EQ((*recorder)->add(makeFrame(2, INT64_MAX)), absl::OkStatus());
  ASSERT_EQ((*recorder)->complete(), absl::OkStatus());
  const auto frames = open({.file = wild, .speed = 0.001});
  const Played played = play(*frames, 2);
  EXPECT_EQ(played.capture_ms.at(0), 0);
  EXPECT_GT(played.capture_ms.at(1), 0);
}

}  // namespace
}  // namespace viewloom::cli::replayed_frames_test
