// SPDX-License-Identifier: Apache-2.0
#include "schedule/stream_frames.h"

#include <gmock/gmock.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace viewloom::stream_frames_test {
namespace {

using testing::HasSubstr;

constexpr int64_t kFrame_ns = 100'000'000;
constexpr int64_t kBuilt_ns = 1'000'000;  // after a frame came

// A frame a tenth of a second after the one before it. `code`: its content.
FramePtr frameOf(uint64_t number, double x_m, uint8_t code = 1) {
  auto frame = std::make_shared<Frame>();
  frame->format.number = number;
  frame->format.capture_time_ns = int64_t(number) * kFrame_ns;
  frame->format.sources = {{.camera = {.pose = {.position_m = {x_m, 0, 0}}}, .layers = {{}}}};
  LayerPlanes planes;
  planes.color = planes.depth = std::make_shared<const std::vector<uint8_t>>(4, code);
  frame->sources = {{planes}};
  frame->times.first_chunk_ns = frame->format.capture_time_ns;
  return frame;
}

class StreamFramesTest : public testing::Test {
 protected:
  bool offer(const FramePtr& frame, uint64_t session = 1) {
    return frames_.offer({frame, session, nullptr}).has_value();
  }
  // Builds the next frame, with surfaces so near, 1/m.
  StreamInstant build(double inv_z_near = 0.5, bool keeps_before = false) {
    OfferedFrame taken = frames_.takeNext();
    auto structure = std::make_shared<ResidentStructure>();
    structure->serial = taken.frame->format.number;
    structure->sources = {{.camera = taken.frame->format.sources[0].camera, .size_px = {64, 64}}};
    structure->stats = {.inv_z_near = inv_z_near, .inv_z_far = inv_z_near / 2};
    structure->built_at_ns = taken.frame->times.first_chunk_ns + kBuilt_ns;
    note_ = frames_.takeDefaults(taken.session, *structure);
    before_ = std::exchange(resident_, structure);
    return frames_.becomeResident(taken.frame, resident_, before_, keeps_before);
  }
  // The next frame says nothing new.
  std::optional<CameraMotion> follow(int64_t now_ns = 0) {
    return frames_.followUnchanged(*resident_, now_ns);
  }

  StreamFrames frames_;
  ResidentPtr before_;
  ResidentPtr resident_;
  std::optional<std::string> note_;
};

TEST_F(StreamFramesTest, buildsTheNewestFrameAndReturnsTheOneItReplaces) {
  EXPECT_EQ(frames_.next(), nullptr);
  EXPECT_FALSE(offer(frameOf(1, 0)));
  const auto replaced = frames_.offer({frameOf(2, 0), 1, nullptr});
  ASSERT_TRUE(replaced);
  EXPECT_EQ(replaced->frame->format.number, 1u);
  ASSERT_NE(frames_.next(), nullptr);
  EXPECT_EQ(frames_.takeNext().frame->format.number, 2u);
  EXPECT_EQ(frames_.next(), nullptr);
}

TEST_F(StreamFramesTest, comparesAFrameWithTheResidentOneNotWithTheLast) {
  offer(frameOf(1, 0, 1));
  build();
  offer(frameOf(2, 0, 2));
  EXPECT_FALSE(follow()) << "it shows something else";
  offer(frameOf(3, 0, 1));
  EXPECT_TRUE(follow()) << "the second was replaced";
}

TEST_F(StreamFramesTest, tellsHowACameraMovesAndThatItStandsAgain) {
  offer(frameOf(1, 0));
  EXPECT_FALSE(build().motion.isMoving());
  offer(frameOf(2, 0.1));
  const CameraMotion motion = build().motion;
  EXPECT_NEAR(motion.camera.velocity_mps.x, 1, 1e-9);
  EXPECT_EQ(motion.interval_ns, kFrame_ns);
  EXPECT_EQ(motion.lag_ns, kFrame_ns + kBuilt_ns);
  offer(frameOf(3, 0.1));
  const auto stands = follow(3 * kFrame_ns);
  ASSERT_TRUE(stands);
  EXPECT_FALSE(stands->isMoving());
}

TEST_F(StreamFramesTest, keepsTheStructureBeforeWhereTheCameraHasMovedAndSomebodyLooksBetween) {
  offer(frameOf(1, 0));
  build(0.5, true);
  offer(frameOf(2, 0.1));
  EXPECT_EQ(build(0.5, true).before, before_);
  offer(frameOf(3, 0.2));
  EXPECT_EQ(build(0.5, false).before, nullptr) << "nobody looks between";
  offer(frameOf(4, 0.2, 9));
  EXPECT_EQ(build(0.5, true).before, nullptr) << "the camera stands";
}

TEST_F(StreamFramesTest, forgetsHowTheCameraOfAnotherPublisherMoved) {
  offer(frameOf(1, 0));
  build();
  offer(frameOf(2, 0.1), 2);
  EXPECT_FALSE(build().motion.isMoving());
}

TEST_F(StreamFramesTest, takesDefaultsFromTheFirstFrameOfAPublisherWithoutANote) {
  offer(frameOf(1, 0));
  build(0.5);
  EXPECT_EQ(note_, std::nullopt);
  EXPECT_EQ(resident_->taking.count, 1u);
  const StreamDefaults first = resident_->defaults;
  offer(frameOf(2, 0, 2));
  build(0.6);
  EXPECT_EQ(resident_->taking.count, 1u) << "depth has hardly moved";
  EXPECT_EQ(resident_->defaults, first);
}

TEST_F(StreamFramesTest, takesDefaultsAnewWhereDepthHasMovedFarAndSaysSo) {
  offer(frameOf(1, 0));
  build(0.5);
  offer(frameOf(100, 0, 2));
  build(50);
  EXPECT_EQ(resident_->taking.reason, DefaultsReason::kDepthMoved);
  ASSERT_TRUE(note_);
  EXPECT_THAT(*note_, HasSubstr("depth was 2 to 4 m and is 0.02 to 0.04 m"));
}

TEST_F(StreamFramesTest, buildsTheSameFrameAgainWhereANewPublisherBringsItsDefaults) {
  offer(frameOf(1, 0));
  build(0.5);
  offer(frameOf(2, 0, 2));
  build(0.6);  // the defaults are still those of the first
  offer(frameOf(3, 0, 2), 2);
  EXPECT_FALSE(follow());
  build(0.6);
  EXPECT_EQ(resident_->taking.reason, DefaultsReason::kNewPublisher);
  ASSERT_TRUE(note_);
  EXPECT_THAT(*note_, HasSubstr("a new publisher: "));
}

TEST(ShowBetweenFrames, isSoOfDisplaysThatInterpolate) {
  auto display = std::make_shared<ActiveDisplay>();
  EXPECT_FALSE(showBetweenFrames({}));
  EXPECT_FALSE(showBetweenFrames({display}));
  display->spec.temporal = TemporalSpec{.output_rate_hz = 50};
  EXPECT_FALSE(showBetweenFrames({display}));
  display->spec.temporal->mode = TemporalMode::kInterpolate;
  EXPECT_TRUE(showBetweenFrames({display}));
}

}  // namespace
}  // namespace viewloom::stream_frames_test
