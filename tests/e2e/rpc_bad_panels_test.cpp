// SPDX-License-Identifier: Apache-2.0
// Panels behind lenses that cannot be: each with the status and the field it is refused with.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "e2e/bad_display.h"

namespace viewloom::rpc_bad_panels_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr auto kInvalid = grpc::StatusCode::INVALID_ARGUMENT;

v1::LenticularDisplay& lenticular(v1::OpenDisplay& open) {
  open.mutable_encoding()->clear_color();
  open.mutable_display()->mutable_lenticular()->set_preset("portrait");
  return *open.mutable_display()->mutable_lenticular();
}

v1::IntegralDisplay& integral(v1::OpenDisplay& open) {
  open.mutable_display()->mutable_integral()->set_preset("near_eye_2013");
  return *open.mutable_display()->mutable_integral();
}

const std::string kLenticular = "open.display.lenticular.";
const std::string kIntegral = "open.display.integral.";

const std::vector<BadDisplay> kLenticularPanels = {
    {"neither preset nor calibration",
     [](auto& o) { lenticular(o).clear_preset(); },
     {kInvalid, kLenticular + "calibration_json"}},
    {"no such preset",
     [](auto& o) { lenticular(o).set_preset("hologram"); },
     {grpc::StatusCode::NOT_FOUND, kLenticular + "preset"}},
    {"a preset whose calibration nobody has published",
     [](auto& o) { lenticular(o).set_preset("kiosk"); },
     {grpc::StatusCode::FAILED_PRECONDITION, kLenticular + "preset"}},
    {"a calibration that is no JSON",
     [](auto& o) { lenticular(o).set_calibration_json("pitch=52"); },
     {kInvalid, kLenticular + "calibration_json.calibration"}},
    {"a pitch of nothing",
     [](auto& o) {
       lenticular(o).set_calibration_json(
           R"({"pitch":0,"slope":-7,"center":0.5,"DPI":324,"screenW":1536,"screenH":2048})");
     },
     {kInvalid, kLenticular + "calibration_json.pitch"}},
    {"a cone of 3 rad",
     [](auto& o) { lenticular(o).set_view_cone_rad(3); },
     {kInvalid, kLenticular + "view_cone_rad"}},
    {"2501 views",
     [](auto& o) { lenticular(o).set_view_count(2501); },
     {kInvalid, kLenticular + "view_count"}},
    {"focus NaN",
     [](auto& o) { lenticular(o).set_focal_distance_m(kNan); },
     {kInvalid, kLenticular + "focal_distance_m"}},
    {"chroma that neighbouring subpixels share",
     [](auto& o) {
       lenticular(o);
       o.mutable_encoding()->set_color(v1::BAND_ENCODING_JPEG);
       o.mutable_encoding()->set_chroma(v1::CHROMA_SUBSAMPLING_420);
     },
     {kInvalid, "open.encoding.chroma"}},
    {"video of subpixels",
     [](auto& o) {
       lenticular(o);
       o.mutable_encoding()->set_color(v1::BAND_ENCODING_H264);
     },
     {kInvalid, "open.encoding.color"}},
};

const std::vector<BadDisplay> kMicrolensPanels = {
    {"video of pixels behind lenses",
     [](auto& o) {
       integral(o);
       o.mutable_encoding()->set_color(v1::BAND_ENCODING_H264);
     },
     {kInvalid, "open.encoding.color"}},
    {"no such preset",
     [](auto& o) { integral(o).set_preset("hologram"); },
     {grpc::StatusCode::NOT_FOUND, kIntegral + "preset"}},
    {"no panel", [](auto& o) { integral(o).clear_preset(); }, {kInvalid, kIntegral + "panel_size"}},
    {"px of a light year",
     [](auto& o) { integral(o).set_pixel_pitch_m(9e15); },
     {kInvalid, kIntegral + "pixel_pitch_m"}},
    {"a lens smaller than its px",
     [](auto& o) { integral(o).set_lens_pitch_m(1e-6); },
     {kInvalid, kIntegral + "lens_pitch_m"}},
    {"focal length NaN",
     [](auto& o) { integral(o).set_focal_length_m(kNan); },
     {kInvalid, kIntegral + "focal_length_m"}},
    {"more lenses than there is room for",
     [](auto& o) { integral(o).set_lens_columns(1000); },
     {kInvalid, kIntegral + "lens_columns"}},
    {"lenses beside the panel",
     [](auto& o) { integral(o).set_offset_y_px(1e6); },
     {kInvalid, kIntegral + "offset_y_px"}},
    {"a scale below 0",
     [](auto& o) { integral(o).set_scale(-1); },
     {kInvalid, kIntegral + "scale"}},
    {"a panel behind the eye",
     [](auto& o) { integral(o).set_distance_m(-1); },
     {kInvalid, kIntegral + "distance_m"}},
};

TEST(StreamAtlases, refusesLenticularPanelsThatCannotBe) {
  expectRefused(kLenticularPanels);
}
TEST(StreamAtlases, refusesMicrolensPanelsThatCannotBe) {
  expectRefused(kMicrolensPanels);
}

}  // namespace
}  // namespace viewloom::rpc_bad_panels_test
