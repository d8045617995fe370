// SPDX-License-Identifier: Apache-2.0
// Displays of colour with depth that cannot be served: each with the field it is refused with.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "e2e/bad_display.h"

namespace viewloom::rpc_bad_rgbd_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr auto kInvalid = grpc::StatusCode::INVALID_ARGUMENT;
const std::string kRgbd = "open.display.rgbd.";

v1::RgbdDisplay& rgbd(v1::OpenDisplay& open) {
  v1::RgbdDisplay& display = *open.mutable_display()->mutable_rgbd();
  display.mutable_view_size()->set_width(8);
  display.mutable_view_size()->set_height(8);
  return display;
}

const std::vector<BadDisplay> kRgbds = {
    {"no size", [](auto& o) { rgbd(o).clear_view_size(); }, {kInvalid, kRgbd + "view_size"}},
    {"a side of 8193",
     [](auto& o) { rgbd(o).mutable_view_size()->set_height(8193); },
     {kInvalid, kRgbd + "view_size.height"}},
    {"form 99",
     [](auto& o) { rgbd(o).set_form(static_cast<v1::RgbdForm>(99)); },
     {kInvalid, kRgbd + "form"}},
    {"placement 99",
     [](auto& o) { rgbd(o).set_depth_placement(static_cast<v1::DepthPlacement>(99)); },
     {kInvalid, kRgbd + "depth_placement"}},
    {"a place among quadrants",
     [](auto& o) {
       rgbd(o).set_form(v1::RGBD_FORM_TWO_LAYERS);
       rgbd(o).set_depth_placement(v1::DEPTH_PLACEMENT_LEFT);
     },
     {kInvalid, kRgbd + "depth_placement"}},
    {"a place of 16 bits",
     [](auto& o) {
       rgbd(o).set_depth_bits(16);
       rgbd(o).set_depth_placement(v1::DEPTH_PLACEMENT_TOP);
     },
     {kInvalid, kRgbd + "depth_placement"}},
    {"a quilt's preset",
     [](auto& o) { rgbd(o).set_preset("portrait"); },
     {grpc::StatusCode::NOT_FOUND, kRgbd + "preset"}},
    {"7 bits", [](auto& o) { rgbd(o).set_depth_bits(7); }, {kInvalid, kRgbd + "depth_bits"}},
    {"near NaN", [](auto& o) { rgbd(o).set_near_m(kNan); }, {kInvalid, kRgbd + "near_m"}},
    {"far behind", [](auto& o) { rgbd(o).set_far_m(-3); }, {kInvalid, kRgbd + "far_m"}},
    {"far before near",
     [](auto& o) {
       rgbd(o).set_near_m(3);
       rgbd(o).set_far_m(2);
     },
     {kInvalid, kRgbd + "far_m"}},
    {"a screen at the eye",
     [](auto& o) { rgbd(o).set_screen_m(1e-7); },
     {kInvalid, kRgbd + "screen_m"}},
    {"field of view 3", [](auto& o) { rgbd(o).set_fov_y_rad(3); }, {kInvalid, kRgbd + "fov_y_rad"}},
};

TEST(StreamAtlases, refusesColorWithDepthThatCannotBe) {
  expectRefused(kRgbds);
}

}  // namespace
}  // namespace viewloom::rpc_bad_rgbd_test
