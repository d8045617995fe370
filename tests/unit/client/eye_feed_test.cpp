// SPDX-License-Identifier: Apache-2.0
#include "eyes/eye_feed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <vector>

namespace viewloom::eye_feed_test {
namespace {

using testing::HasSubstr;

TEST(EyeFeed, readsALineOfATracker) {
  const auto poses = parseEyePoses(
      R"({"left": [-0.03, 1e-2, 0.5], "right": [0.03, 0, 1], "time_ns": 7, "confidence": 0.9})");
  ASSERT_TRUE(poses.ok()) << poses.status();
  EXPECT_EQ(poses->time_ns(), 7);
  EXPECT_EQ(poses->predicted_display_time_ns(), 0);
  ASSERT_EQ(poses->eyes_size(), 2);
  EXPECT_EQ(poses->eyes(0).pose().position().x(), -0.03);
  EXPECT_EQ(poses->eyes(0).pose().position().y(), 0.01);
  EXPECT_EQ(poses->eyes(1).pose().position().z(), 1);
  EXPECT_EQ(poses->eyes(0).projection_case(), v1::Camera::PROJECTION_NOT_SET);
  const auto predicted = parseEyePoses(
      R"({"time_ns": -1, "predicted_display_time_ns": 9, "left": [0,0,0], "right": [0,0,0]})");
  ASSERT_TRUE(predicted.ok()) << predicted.status();
  EXPECT_EQ(predicted->time_ns(), -1);
  EXPECT_EQ(predicted->predicted_display_time_ns(), 9);
}

TEST(EyeFeed, saysWhatALineLacks) {
  struct BadLine {
    const char* line;
    const char* problem;
  };
  const BadLine cases[] = {
      {"", "is not a JSON object"},
      {"[1, 2]", "is not a JSON object"},
      {R"({"time_ns": 1, )", "is not a JSON object"},
      {R"({"left": [0, 0, 0], "right": [0, 0, 0]})", "time_ns: missing"},
      {R"({"time_ns": 1.5, "left": [0, 0, 0], "right": [0, 0, 0]})", "time_ns: "},
      {R"({"time_ns": 1, "predicted_display_time_ns": "2", "left": [0, 0, 0]})",
       "predicted_display_time_ns: "},
      {R"({"time_ns": 1, "right": [0, 0, 0]})", "left: missing"},
      {R"({"time_ns": 1, "left": [0, 0], "right": [0, 0, 0]})", "left: "},
      {R"({"time_ns": 1, "left": [0, 0, 0], "right": [0, null, 0]})", "right: "},
      {R"({"time_ns": 1, "left": [0, 0, 0], "right": {"x": 0}})", "right: "},
  };
  for (const BadLine& bad : cases) {
    const auto poses = parseEyePoses(bad.line);
    EXPECT_EQ(poses.status().code(), absl::StatusCode::kInvalidArgument) << bad.line;
    EXPECT_THAT(std::string(poses.status().message()), HasSubstr(bad.problem)) << bad.line;
  }
}

TEST(EyeFeed, givesTheLinesOfAFileInOrderAndSaysWhichIsBad) {
  const std::string file =
      testing::TempDir() + "eye_feed_test-" + std::to_string(getpid()) + ".jsonl";
  std::ofstream(file) << R"({"time_ns": 9000000000000000000, "left": [1,0,0], "right": [2,0,0]})"
                      << "\n\n"
                      << R"({"time_ns": -9000000000000000000, "left": [3,0,0], "right": [4,0,0]})"
                      << "\nnothing\n"
                      << R"({"time_ns": 1, "left": [5,0,0], "right": [6,0,0]})";
  std::vector<double> places;
  std::promise<absl::Status> failed;
  {
    auto feed = EyeFeed::open(file);
    ASSERT_TRUE(feed.ok()) << feed.status();
    (*feed)->start({.send =
                        [&](const v1::EyePoses& poses) {
                          places.push_back(poses.eyes(0).pose().position().x());
                        },
                    .on_failure = [&](const absl::Status& status) { failed.set_value(status); }});
    EXPECT_THAT(std::string(failed.get_future().get().message()),
                HasSubstr(file + ", line 4: is not a JSON object"));
  }
  EXPECT_THAT(places, testing::ElementsAre(1, 3));
  std::filesystem::remove(file);
  EXPECT_THAT(std::string(EyeFeed::open(file).status().message()), HasSubstr("No such file"));
}

TEST(EyePoses, refuseALineThatNestsDeeply) {
  const absl::StatusOr<v1::EyePoses> poses =
      parseEyePoses("{\"time_ns\": 1, \"left\": {\"a\": " + std::string(60'000, '['));
  EXPECT_THAT(std::string(poses.status().message()), HasSubstr("deeper than 64 levels"));
}

TEST(EyeFeed, refusesALineWithoutEnd) {
  const std::string file =
      testing::TempDir() + "eye_feed_long-" + std::to_string(getpid()) + ".jsonl";
  std::ofstream(file) << std::string(100'000, ' ');
  std::promise<absl::Status> failed;
  auto feed = EyeFeed::open(file);
  ASSERT_TRUE(feed.ok()) << feed.status();
  (*feed)->start({.send = [](const v1::EyePoses&) { ADD_FAILURE() << "of nothing"; },
                  .on_failure = [&](const absl::Status& status) { failed.set_value(status); }});
  EXPECT_THAT(std::string(failed.get_future().get().message()), HasSubstr("line 1: is longer"));
  feed->reset();
  std::filesystem::remove(file);
}

TEST(EyeFeed, stopsWhileALineIsNotDue) {
  const std::string file =
      testing::TempDir() + "eye_feed_later-" + std::to_string(getpid()) + ".jsonl";
  std::ofstream(file) << R"({"time_ns": 0, "left": [1,0,0], "right": [2,0,0]})"
                      << "\n"
                      << R"({"time_ns": 3600000000000, "left": [3,0,0], "right": [4,0,0]})";
  std::promise<void> first;
  auto feed = EyeFeed::open(file);
  ASSERT_TRUE(feed.ok()) << feed.status();
  (*feed)->start({.send = [&](const v1::EyePoses&) { first.set_value(); },
                  .on_failure = [](const absl::Status& status) { ADD_FAILURE() << status; }});
  first.get_future().wait();
  feed->reset();
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace viewloom::eye_feed_test
