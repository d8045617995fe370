// SPDX-License-Identifier: Apache-2.0
// Reports of a whole server about moving eyes: times, latency and places.
#include <cstdint>
#include <string>

#include "e2e/service_eyes_fixture.h"

namespace viewloom::test::service_motion_test {
namespace {

TEST_F(ServiceEyesTest, saysWhenPosesWereTakenAndHowOldTheyWere) {
  publish();
  const auto tracked = view(openTracked());
  const Atlas before = tracked->waitForFrame(1);
  EXPECT_EQ(before.header.eye_poses_latched_ns(), 0);
  EXPECT_EQ(before.header.eye_poses_age_ns(), 0);
  const int64_t sent_ns = clock_.nowNs();
  const Atlas first = tracked->seenBy(posesAt(1, {-0.1, 0, 0}, {0.1, 0, 0}));
  const int64_t seen_ns = clock_.nowNs();
  EXPECT_GE(first.header.eye_poses_age_ns(), 0);
  EXPECT_GE(first.header.eye_poses_latched_ns() - first.header.eye_poses_age_ns(), sent_ns);
  EXPECT_LE(first.header.eye_poses_latched_ns() + first.end.times().trace_ns() +
                first.end.times().encode_ns(),
            seen_ns);
  // The client falls silent, the stream goes on.
  publish();
  const Atlas later = tracked->waitForFrame(2);
  EXPECT_EQ(later.header.eye_poses_time_ns(), 1);
  EXPECT_EQ(later.header.eye_poses_latched_ns() - later.header.eye_poses_age_ns(),
            first.header.eye_poses_latched_ns() - first.header.eye_poses_age_ns())
      << "they came in once";
  EXPECT_GE(later.header.eye_poses_age_ns(), seen_ns - first.header.eye_poses_latched_ns());
}

TEST_F(ServiceEyesTest, countsFromMotionToPicture) {
  publish();
  const auto tracked = view(openTracked());
  const auto presented = [&](const Atlas& atlas, int64_t time_ns) {
    tracked->watcher().reportPresented(atlas.header.sequence(), time_ns);
  };
  presented(tracked->waitForFrame(1), 5);  // seen by nobody's eyes
  presented(tracked->seenBy(posesAt(1'000'000'000, {-0.1, 0, 0}, {0.1, 0, 0})), 1'023'000'000);
  presented(tracked->seenBy(posesAt(2'000'000'000, {-0.2, 0, 0}, {0.1, 0, 0})), 2'230'000'000);
  tracked->seenBy(posesAt(3, {-0.3, 0, 0}, {0.1, 0, 0}));  // what came before it is handled
  const std::string metrics = service_->metrics().text();
  const auto holds = [&](const std::string& line) {
    EXPECT_NE(metrics.find("viewloom_" + line + "\n"), std::string::npos) << line;
  };
  holds("atlases_presented_total 3");
  holds("motion_to_image_seconds_bucket{le=\"0.02\"} 0");
  holds("motion_to_image_seconds_bucket{le=\"0.03\"} 1");
  holds("motion_to_image_seconds_bucket{le=\"0.25\"} 2");
  holds("motion_to_image_seconds_count 2");
  holds("eye_poses_age_seconds_count 3");
}

TEST_F(ServiceEyesTest, tellsThePublisherWhereEyesAreOfAFrameThatStands) {
  publish();
  const auto tracked = view(openTracked());
  tracked->waitForFrame(1);
  for (const double x_m : {0.25, -0.5}) {
    tracked->seenBy(posesAt(int64_t(100 * x_m), {x_m, 0.125, 0}, {x_m + 0.0625, 0.125, 0}));
    const v1::Wanted wanted = wanted_.waitFor([&](const v1::Wanted& told) {
      return std::abs(told.pose().position().x() - (x_m + 0.03125)) < 1e-9;
    });
    EXPECT_EQ(wanted.display_count(), 1u);
    EXPECT_NEAR(wanted.pose().position().y(), 0.125, 1e-9);
  }
}

// The newest are those that came last, whatever time they say; from kilometres away there is little
// to see, and the next poses are as good as ever.
TEST_F(ServiceEyesTest, answersEyesFromFarAwayAndOfAnyTime) {
  publish();
  const auto tracked = view(openTracked());
  const auto fixed = view(openEyes());
  for (const int64_t time_ns : {INT64_MAX - 20'000'000, INT64_MIN, int64_t{4}, int64_t{-4}}) {
    const Atlas near = tracked->seenBy(posesAt(time_ns, {0.25, 0, 0}, {0.3125, 0, 0}));
    EXPECT_EQ(near.header.predicted_display_time_ns(), time_ns + 11'000'000);
    EXPECT_EQ(colorOf(near), colorOf(fixedAt({0.25, 0, 0}, {0.3125, 0, 0})));
    const Atlas far = tracked->seenBy(posesAt(time_ns + 1, {7000, -3000, 9000}, {7000, 8000, 0}));
    const v1::Coverage& coverage = far.end.coverage();
    EXPECT_NEAR(coverage.hit() + coverage.hit_assumed() + coverage.hidden() + coverage.outside() +
                    coverage.empty(),
                1, 1e-9);
  }
  publish();
  EXPECT_EQ(fixed->waitForFrame(2).header.sequence(), 2u) << "others get their frames";
}

}  // namespace
}  // namespace viewloom::test::service_motion_test
