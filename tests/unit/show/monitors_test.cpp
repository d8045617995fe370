// SPDX-License-Identifier: Apache-2.0
#include "show/monitors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::show::monitors_test {
namespace {

using testing::HasSubstr;

const std::vector<Monitor> kMonitors = {
    {.number = 0, .name = "DELL", .size_px = {1920, 1200}},
    {.number = 1, .name = "LKG-P", .size_px = {1536, 2048}},
    {.number = 2, .name = "DELL", .size_px = {1536, 2048}},
};

std::string refusal(const MonitorChoice& choice, const std::vector<Monitor>& monitors = kMonitors) {
  const absl::StatusOr<Monitor> chosen = chooseMonitor(monitors, choice);
  EXPECT_EQ(chosen.status().code(), absl::StatusCode::kInvalidArgument);
  return std::string(chosen.status().message());
}

TEST(Monitors, theOneOfThePanelsSizeIsThePanel) {
  EXPECT_EQ(chooseMonitor(kMonitors, {.panel_px = SizePx{1536, 2048}})->number, 1);
}

TEST(Monitors, theUsersWordGoesBeforeThePanelsSize) {
  EXPECT_EQ(chooseMonitor(kMonitors, {.number = 0, .panel_px = SizePx{1536, 2048}})->number, 0);
}

TEST(Monitors, anyIsGoodForAWindowOrWithoutAPanel) {
  EXPECT_EQ(chooseMonitor(kMonitors, {})->number, 0);
  EXPECT_EQ(chooseMonitor(kMonitors, {.panel_px = SizePx{3840, 2160}, .is_windowed = true})->number,
            0);
}

TEST(Monitors, aRefusalListsThoseThatAreThere) {
  EXPECT_EQ(refusal({.number = 7}),
            "--monitor 7: there is no such monitor; there are 0: DELL (1920x1200), 1: LKG-P "
            "(1536x2048), 2: DELL (1536x2048)");
  EXPECT_THAT(refusal({.number = -1}), HasSubstr("--monitor -1: there is no such monitor"));
  EXPECT_THAT(refusal({.panel_px = SizePx{3840, 2160}}),
              HasSubstr("no monitor has the 3840x2160 px of the calibrated panel; there are 0:"));
  EXPECT_THAT(refusal({}, {}), HasSubstr("there are none"));
}

TEST(Monitors, pxOfAWindowHaveToBePxOfThePanel) {
  EXPECT_TRUE(checkNativePixels({1536, 2048}, {1536, 2048}).ok());
  const absl::Status scaled = checkNativePixels({768, 1024}, {1536, 2048});
  EXPECT_EQ(scaled.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(scaled.message()), HasSubstr("768x1024"));
  EXPECT_FALSE(checkNativePixels({2048, 1536}, {1536, 2048}).ok());
}

}  // namespace
}  // namespace viewloom::show::monitors_test
