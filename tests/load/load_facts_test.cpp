// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "load/load_report.h"

namespace viewloom::load::load_facts_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const LoadOptions kOptions{.publishers = 1, .displays = 1};

LoadResult goodResult() {
  PublisherBook publisher;
  publisher.stream = "s";
  publisher.counts.offered = 12;
  publisher.counts.replaced_here = 2;
  publisher.counts.sent = 10;
  publisher.traced = 4;
  publisher.reported_frames = 10;
  DisplayBook display;
  display.stream = "s";
  display.kind = "quilt";
  display.counts.atlases.whole = 4;
  display.end = absl::CancelledError("stopped");
  LoadResult result;
  result.seconds = 40;
  result.publishers = {publisher};
  result.displays = {display};
  result.server_usage.assign(40, {.resident_bytes = 500'000'000, .cpu_ns = 1});
  return result;
}

std::vector<std::string> problemsAfter(const std::function<void(LoadResult&)>& spoil) {
  LoadResult result = goodResult();
  spoil(result);
  return findProblems(kOptions, result);
}

TEST(LoadFacts, holdForAGoodRun) {
  EXPECT_THAT(problemsAfter([](LoadResult&) {}), testing::IsEmpty());
}

TEST(LoadFacts, catchALostAndARepeatedReport) {
  EXPECT_THAT(problemsAfter([](LoadResult& r) { r.publishers[0].reported_frames = 9; }),
              ElementsAre(HasSubstr("sent 10 frames and got reports of 9")));
  EXPECT_THAT(problemsAfter([](LoadResult& r) { r.publishers[0].repeated_reports = 1; }),
              ElementsAre(HasSubstr("more than one report")));
}

TEST(LoadFacts, catchSequencesAndFramesThatGoBack) {
  EXPECT_THAT(problemsAfter([](LoadResult& r) { r.displays[0].sequences_back = 1; }),
              ElementsAre(HasSubstr("sequence that did not grow")));
  EXPECT_THAT(problemsAfter([](LoadResult& r) { r.displays[0].frames_back = 1; }),
              ElementsAre(HasSubstr("older frame")));
}

TEST(LoadFacts, catchDropsThatWereNotTold) {
  EXPECT_THAT(problemsAfter([](LoadResult& r) {
                r.displays[0].counts.atlases.gaps = 2;
                r.displays[0].counts.atlases.skipped = 1;
              }),
              ElementsAre(HasSubstr("misses 2 atlases and was told of 1")));
}

TEST(LoadFacts, catchErrorsAndSilence) {
  EXPECT_THAT(
      problemsAfter([](LoadResult& r) { r.publishers[0].end = absl::UnavailableError("gone"); }),
      ElementsAre(HasSubstr("gone")));
  EXPECT_THAT(problemsAfter([](LoadResult& r) { r.displays[0].counts.atlases.whole = 0; }),
              ElementsAre(HasSubstr("got no atlas")));
  EXPECT_THAT(problemsAfter([](LoadResult& r) { r.displays.clear(); }),
              ElementsAre(HasSubstr("missing")));
  EXPECT_THAT(problemsAfter([](LoadResult& r) { r.server_exit_code = 3; }),
              ElementsAre(HasSubstr("exit code 3")));
}

TEST(LoadFacts, catchMemoryThatGrowsOn) {
  EXPECT_THAT(problemsAfter([](LoadResult& r) {
                for (size_t i = 0; i < r.server_usage.size(); ++i) {
                  r.server_usage[i].resident_bytes = 100'000'000 + 20'000'000 * i;
                }
              }),
              ElementsAre(HasSubstr("under a steady load")));
}

}  // namespace
}  // namespace viewloom::load::load_facts_test
