// SPDX-License-Identifier: Apache-2.0
#include "schedule/atlas_job.h"

#include <gmock/gmock.h>

#include <memory>
#include <string>
#include <vector>

namespace viewloom::atlas_job_test {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::SizeIs;

constexpr int64_t kNow_ns = 5'000'000'000;

DisplaySpec quiltOf(uint32_t side_px) {
  return *completeDisplaySpec(
      {.kind = QuiltSpec{
           .columns = 2, .rows = 2, .size_px = {side_px, side_px}, .view_cone_rad = 0.5}});
}

DisplaySpec trackedStereo() {
  return *completeDisplaySpec({.kind = StereoSpec{.eye_size_px = {100, 100}, .is_tracked = true}});
}

ActiveDisplayPtr displayOf(const std::string& picture_key, const DisplaySpec& spec) {
  auto display = std::make_shared<ActiveDisplay>();
  display->picture_key = picture_key;
  display->spec = spec;
  return display;
}

ResidentPtr someStructure() {
  return std::make_shared<const ResidentStructure>();
}

TEST(Deadline, isLaterForMoreRays) {
  EXPECT_EQ(deadlineNs(quiltOf(64), kNow_ns), kNow_ns + 64 * 64 * kDueNsPerRay);
  EXPECT_EQ(deadlineNs(quiltOf(128), kNow_ns), kNow_ns + 128 * 128 * kDueNsPerRay);
}

TEST(Deadline, ofTrackedDisplaysIsAheadOfOthersThatAreOverdue) {
  EXPECT_EQ(deadlineNs(trackedStereo(), kNow_ns),
            kNow_ns + 2 * 100 * 100 * kDueNsPerRay - kEyesAhead_ns);
}

TEST(JobsOfFrame, areOneForEachPicture) {
  const ResidentPtr structure = someStructure();
  const auto ticket = std::make_shared<FrameTicket>(1, nullptr);
  const auto jobs = jobsOfFrame(structure,
                                {displayOf("small", quiltOf(64)), displayOf("small", quiltOf(64)),
                                 displayOf("large", quiltOf(128))},
                                ticket, kNow_ns);
  EXPECT_THAT(jobs, ElementsAre(Field(&AtlasJob::picture_key, "small"),
                                Field(&AtlasJob::picture_key, "large")));
  for (const AtlasJob& job : jobs) {
    EXPECT_EQ(job.structure, structure);
    EXPECT_EQ(job.ticket, ticket);
    EXPECT_EQ(job.asked_ns, kNow_ns);
    EXPECT_FALSE(job.is_tracked);
    EXPECT_FALSE(job.tick);
  }
}

TEST(JobsOfFrame, leaveDisplaysWithARateToTheirTicks) {
  DisplaySpec ticking = quiltOf(64);
  ticking.temporal = TemporalSpec{.output_rate_hz = 50};
  EXPECT_THAT(jobsOfFrame(someStructure(), {displayOf("quilt", ticking)}, nullptr, kNow_ns),
              SizeIs(0));
}

TEST(JobsOfFrame, sayWhenTheEyesOfATrackedDisplayCame) {
  ActiveDisplay display = *displayOf("eyes", trackedStereo());
  display.eyes = std::make_shared<EyeTrack>();
  display.eyes->put({.received_ns = 10});
  display.eyes->put({.received_ns = 30});
  const auto jobs =
      jobsOfFrame(someStructure(), {std::make_shared<ActiveDisplay>(display)}, nullptr, kNow_ns);
  ASSERT_THAT(jobs, SizeIs(1));
  EXPECT_TRUE(jobs[0].is_tracked);
  EXPECT_FALSE(jobs[0].is_for_eyes) << "it is for the frame";
  EXPECT_EQ(jobs[0].poses.received_ns, 30);
  EXPECT_EQ(jobs[0].poses.interval_ns, 20);
  const AtlasJob moved = jobForEyes(display, jobs[0].structure, kNow_ns);
  EXPECT_TRUE(moved.is_for_eyes);
  EXPECT_EQ(moved.ticket, nullptr);
  EXPECT_EQ(moved.deadline_ns, jobs[0].deadline_ns);
  EXPECT_EQ(moved.poses.received_ns, 30);
}

}  // namespace
}  // namespace viewloom::atlas_job_test
