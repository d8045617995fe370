// SPDX-License-Identifier: Apache-2.0
// Texts in which displays are refused.
#include <numbers>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "display/display_spec.h"

namespace viewloom::refused_display_test {
namespace {

std::string refusalOf(QuiltSpec quilt) {
  return std::string(completeDisplaySpec({.kind = std::move(quilt)}).status().message());
}

TEST(RefusedDisplay, saysThatASizeIsMissing) {
  EXPECT_EQ(std::string(completeDisplaySpec({.kind = StereoSpec{}}).status().message()),
            "stereo.eye_size: missing; accepted is a width and a height of 1..8192 px, for example "
            "{\"width\": 1024, \"height\": 1024}");
}

TEST(RefusedDisplay, saysWhatAQuiltWithoutASizeNeeds) {
  EXPECT_EQ(refusalOf({.columns = 8, .rows = 6}),
            "quilt.size: missing; accepted is the width and the height of the whole quilt, "
            "1..16384 px each, for example {\"width\": 3360, \"height\": 3360}. A quilt needs "
            "columns, rows and size, or a preset");
}

TEST(RefusedDisplay, tellsAnglesInBothUnits) {
  EXPECT_EQ(
      refusalOf(
          {.columns = 8, .rows = 6, .size_px = {3360, 3360}, .view_cone_rad = std::numbers::pi}),
      "quilt.view_cone_rad: got 3.14159 rad (180 degrees); accepted is 0..2.6 rad "
      "(0..148.969 degrees)");
}

}  // namespace
}  // namespace viewloom::refused_display_test
