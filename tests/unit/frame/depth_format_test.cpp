// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "frame/depth.h"

namespace viewloom::depth_format_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

struct Case {
  DepthFormat format;
  PlaneEncoding encoding;
  const char* field;  // at fault; "" = accepted
};

DepthFormat window(double min_depth, double max_depth, double near_z_m, double far_z_m) {
  return {.meaning = DepthMeaning::kWindow,
          .min_depth = min_depth,
          .max_depth = max_depth,
          .near_z_m = near_z_m,
          .far_z_m = far_z_m};
}

DepthFormat planar(double scale, double offset) {
  return {.meaning = DepthMeaning::kPlanar, .scale = scale, .offset = offset};
}

DepthFormat withInvalid(double value) {
  return {.meaning = DepthMeaning::kPlanar, .invalid_value = value};
}

TEST(ValidateDepthFormat, namesTheFieldAtFault) {
  const PlaneEncoding f32 = PlaneEncoding::kDepthF32;
  const PlaneEncoding u16 = PlaneEncoding::kDepthU16;
  const std::vector<Case> cases{
      {planar(1, 0), f32, ""},
      {planar(-0.001, 5), u16, ""},
      {planar(0, 0), f32, "depth.scale"},
      {planar(kNan, 0), f32, "depth.scale"},
      {planar(kInf, 0), f32, "depth.scale"},
      {planar(1e-40, 0), f32, "depth.scale"},
      {planar(1, kNan), f32, "depth.offset"},
      {planar(1, -kInf), f32, "depth.offset"},
      {window(0, 1, 0.1, 100), f32, ""},
      {window(0, 1, 0.1, kInf), u16, ""},
      {window(0, 1, kInf, 0.1), f32, ""},
      {window(0.2, 0.8, 100, 0.1), f32, ""},
      {window(-0.1, 1, 0.1, 100), f32, "depth.min_depth"},
      {window(kNan, 1, 0.1, 100), f32, "depth.min_depth"},
      {window(0.5, 0.5, 0.1, 100), f32, "depth.max_depth"},
      {window(0.8, 0.2, 0.1, 100), f32, "depth.max_depth"},
      {window(0, 1.5, 0.1, 100), f32, "depth.max_depth"},
      {window(0, 1, 0, 100), f32, "depth.near_z_m"},
      {window(0, 1, -1, 100), f32, "depth.near_z_m"},
      {window(0, 1, kNan, 100), f32, "depth.near_z_m"},
      {window(0, 1, 0.1, 0), f32, "depth.far_z_m"},
      {window(0, 1, 5, 5), f32, "depth.far_z_m"},
      {window(0, 1, kInf, kInf), f32, "depth.far_z_m"},
      {window(0, 1, 0.1, kNan), f32, "depth.far_z_m"},
      {withInvalid(0), u16, ""},
      {withInvalid(65535), u16, ""},
      {withInvalid(1e10), f32, ""},
      {withInvalid(kInf), f32, ""},
      {withInvalid(65536), u16, "depth.invalid_value"},
      {withInvalid(-1), u16, "depth.invalid_value"},
      {withInvalid(0.5), u16, "depth.invalid_value"},
      {withInvalid(kNan), u16, "depth.invalid_value"},
      {withInvalid(kNan), f32, "depth.invalid_value"},
      {{.invalid_is_far = true}, f32, "depth.invalid_is_far"},
  };
  for (size_t i = 0; i < cases.size(); ++i) {
    const absl::Status status = validateDepthFormat(cases[i].format, cases[i].encoding, "depth");
    EXPECT_EQ(fieldOf(status), cases[i].field) << "case " << i << ": " << status;
    EXPECT_EQ(status.ok(), *cases[i].field == '\0') << "case " << i;
  }
}

}  // namespace
}  // namespace viewloom::depth_format_test
