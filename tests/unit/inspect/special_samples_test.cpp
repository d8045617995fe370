// SPDX-License-Identifier: Apache-2.0
// Numbers that are no plain depth, in every meaning and encoding: what inspect, the client's
// encoder and the server's columns take them for, against one table.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include <glm/gtc/packing.hpp>

#include "frame/decode_depth.h"
#include "inspect/depth_samples.h"
#include "lib/inverse_depth.h"
#include "messages/source_from_proto.h"
#include "sweep/depth_columns.h"

namespace viewloom::inspect::special_samples_test {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kSubnormal = 1e-40F;
constexpr Intrinsics kCamera{{2, 2}, {0.5, 0.5}};  // the only px lies on the axis

struct Case {
  const char* name;
  v1::DepthMeaning meaning;
  float sample;
  float inv_z;  // or kNoSurface
  bool is_bad = false;
  double scale = 1;
  double offset = 0;
  std::optional<double> invalid = std::nullopt;
  bool is_far = false;
};

constexpr v1::DepthMeaning kPlanar = v1::DEPTH_MEANING_PLANAR;
constexpr v1::DepthMeaning kRay = v1::DEPTH_MEANING_RAY_DISTANCE;
constexpr v1::DepthMeaning kDisparity = v1::DEPTH_MEANING_DISPARITY;
constexpr v1::DepthMeaning kWindow = v1::DEPTH_MEANING_WINDOW;  // 0.5 m .. inf

const std::vector<Case> kTable{
    {"metres", kPlanar, 4, 0.25F},
    {"distance", kRay, 4, 0.25F},
    {"+inf metres", kPlanar, kInf, 0},
    {"+inf of a ray", kRay, kInf, 0},
    {"-inf metres", kPlanar, -kInf, kNoSurface, true},
    {"-inf of a ray", kRay, -kInf, kNoSurface, true},
    {"-inf along -z", kPlanar, -kInf, 0, false, -1},
    {"+inf along -z", kPlanar, kInf, kNoSurface, true, -1},
    {"NaN metres", kPlanar, kNan, kNoSurface, true},
    {"negative metres", kPlanar, -4, kNoSurface, true},
    {"negative along -z", kPlanar, -4, 0.25F, false, -1},
    {"0 metres", kPlanar, 0, kNoSurface},
    {"-0 metres", kPlanar, -0.0F, kNoSurface},
    {"0 of a ray", kRay, 0, kNoSurface},
    {"0 by the offset", kPlanar, 2, kNoSurface, false, 1, -2},
    {"nearer than a nanometre", kPlanar, 1e-10F, kNoSurface, true},
    {"1/Z", kDisparity, 0.25F, 0.25F},
    {"0 1/m", kDisparity, 0, 0},
    {"-0 1/m", kDisparity, -0.0F, 0},
    {"-0 1/m with an offset of -0", kDisparity, -0.0F, 0, false, 1, -0.0},
    {"0 1/m of a negative scale", kDisparity, 0, 0, false, -1},
    {"+inf 1/m", kDisparity, kInf, kNoSurface, true},
    {"-inf 1/m", kDisparity, -kInf, kNoSurface, true},
    {"-inf 1/m of a negative scale", kDisparity, -kInf, kNoSurface, true, -1},
    {"NaN 1/m", kDisparity, kNan, kNoSurface, true},
    {"behind infinity", kDisparity, 0.25F, kNoSurface, true, 1, -0.5},
    {"subnormal 1/m", kDisparity, kSubnormal, 0},
    {"window near", kWindow, 0, 2},
    {"window far", kWindow, 1, 0},
    {"window beyond far", kWindow, 1.5F, kNoSurface, true},
    {"window -inf", kWindow, -kInf, kNoSurface, true},
    {"window +inf", kWindow, kInf, kNoSurface, true},
    {"window NaN", kWindow, kNan, kNoSurface, true},
    {"the invalid value", kPlanar, 7, kNoSurface, false, 1, 0, 7},
    {"the invalid value that is far", kPlanar, 7, 0, false, 1, 0, 7, true},
    {"-inf as the invalid value", kPlanar, -kInf, kNoSurface, false, 1, 0, -kInf},
    {"-inf as the far value", kPlanar, -kInf, 0, false, 1, 0, -kInf, true},
    {"-0 where 0 is far", kPlanar, -0.0F, 0, false, 1, 0, 0, true},
};

struct Answer {
  float inv_z = 0;
  bool is_bad = false;
};

v1::Plane planeOf(const Case& its, v1::PlaneEncoding encoding) {
  v1::Plane plane;
  plane.set_kind(v1::PLANE_KIND_DEPTH);
  plane.set_encoding(encoding);
  plane.mutable_size()->set_width(1);
  plane.mutable_size()->set_height(1);
  v1::DepthFormat& format = *plane.mutable_depth();
  format.set_meaning(its.meaning);
  format.set_scale(its.scale);
  format.set_offset(its.offset);
  if (its.meaning == kWindow) {
    format.set_near_z_m(0.5);
    format.set_far_z_m(double{kInf});
  }
  if (its.invalid) format.set_invalid_value(*its.invalid);
  format.set_invalid_is_far(its.is_far);
  return plane;
}

std::vector<uint8_t> bytesOf(float sample, v1::PlaneEncoding encoding) {
  std::vector<uint8_t> bytes(encoding == v1::PLANE_ENCODING_DEPTH_F32 ? 4 : 2);
  const uint16_t half = glm::packHalf1x16(sample);
  const auto code = static_cast<uint16_t>(sample);
  if (bytes.size() == 4) std::memcpy(bytes.data(), &sample, 4);
  if (encoding == v1::PLANE_ENCODING_DEPTH_F16) std::memcpy(bytes.data(), &half, 2);
  if (encoding == v1::PLANE_ENCODING_DEPTH_U16) std::memcpy(bytes.data(), &code, 2);
  return bytes;
}

Answer inspected(const v1::Plane& plane, const std::vector<uint8_t>& bytes) {
  v1::Camera camera;
  v1::Intrinsics& intrinsics = *camera.mutable_intrinsics();
  intrinsics.set_focal_x_px(2);
  intrinsics.set_focal_y_px(2);
  intrinsics.set_principal_x_px(0.5);
  intrinsics.set_principal_y_px(0.5);
  const auto samples = readDepthSamples(plane, bytes, camera);
  EXPECT_TRUE(samples.ok()) << samples.status();
  return {samples->inv_z[0], samples->bad_count > 0};
}

Answer served(const v1::Plane& plane, const std::vector<uint8_t>& bytes) {
  Frame frame;
  SourceFormat& source = frame.format.sources.emplace_back();
  source.camera.intrinsics = kCamera;
  LayerFormat& layer = source.layers.emplace_back();
  layer.depth.kind = PlaneKind::kDepth;
  layer.depth.encoding = plane.encoding() == v1::PLANE_ENCODING_DEPTH_F32 ? PlaneEncoding::kDepthF32
                         : plane.encoding() == v1::PLANE_ENCODING_DEPTH_F16
                             ? PlaneEncoding::kDepthF16
                             : PlaneEncoding::kDepthU16;
  layer.depth.size_px = {1, 1};
  layer.depth.depth = *depthFormatFromProto(plane.depth());
  frame.sources.emplace_back().emplace_back().depth =
      std::make_shared<const std::vector<uint8_t>>(bytes);
  DepthColumns columns;
  columns.beginFrame(frame);
  const ColumnCounts counts = columns.prepareRows(0, 1);
  return {columns.row(0, 0)[0], counts.bad_samples_count > 0};
}

void expectAnswer(const Answer& answer, const Case& its, float tolerance, const char* who) {
  EXPECT_NEAR(answer.inv_z, its.inv_z, tolerance) << who << ": " << its.name;
  EXPECT_FALSE(answer.inv_z == 0 && std::signbit(answer.inv_z)) << who << ": " << its.name;
  EXPECT_EQ(answer.is_bad, its.is_bad) << who << ": " << its.name;
}

TEST(SpecialSamples, areTheSameToInspectAndServer) {
  for (const Case& its : kTable) {
    const v1::Plane plane = planeOf(its, v1::PLANE_ENCODING_DEPTH_F32);
    const std::vector<uint8_t> bytes = bytesOf(its.sample, plane.encoding());
    expectAnswer(inspected(plane, bytes), its, 1e-7F, "inspect");
    expectAnswer(served(plane, bytes), its, 1e-7F, "server");
    const auto sent = inverseDepth(plane, bytes, kCamera, false);
    ASSERT_TRUE(sent.has_value()) << its.name;
    EXPECT_NEAR((*sent)[0], its.inv_z, 1e-7F) << "client: " << its.name;
  }
}

TEST(SpecialSamples, areTheSameOfHalves) {
  for (const Case& its : kTable) {
    // Neither is a number of its own in binary16.
    if (its.sample == kSubnormal || its.sample == 1e-10F) continue;
    const v1::Plane plane = planeOf(its, v1::PLANE_ENCODING_DEPTH_F16);
    const std::vector<uint8_t> bytes = bytesOf(its.sample, plane.encoding());
    expectAnswer(inspected(plane, bytes), its, 1e-3F, "inspect");
    expectAnswer(served(plane, bytes), its, 1e-3F, "server");
  }
}

TEST(SpecialSamples, areTheSameOfWholeNumbers) {
  const std::vector<Case> table{
      {"millimetres", kPlanar, 4000, 0.25F, false, 0.001},
      {"0 mm", kPlanar, 0, kNoSurface, false, 0.001},
      {"0 mm that is far", kPlanar, 0, 0, false, 0.001, 0, 0, true},
      {"the last code", kPlanar, 65535, 1 / 65.535F, false, 0.001},
      {"along -z", kPlanar, 4000, kNoSurface, true, -0.001},
      {"0 1/m", kDisparity, 0, 0, false, 0.001},
      {"0 1/m without surface", kDisparity, 0, kNoSurface, false, 0.001, 0, 0},
      {"behind infinity", kDisparity, 1, kNoSurface, true, 0.001, -1},
      {"window near", kWindow, 0, 2},
      {"window far", kWindow, 65535, 0},
  };
  for (const Case& its : table) {
    const v1::Plane plane = planeOf(its, v1::PLANE_ENCODING_DEPTH_U16);
    const std::vector<uint8_t> bytes = bytesOf(its.sample, plane.encoding());
    expectAnswer(inspected(plane, bytes), its, 1e-6F, "inspect");
    expectAnswer(served(plane, bytes), its, 1e-6F, "server");
  }
}

}  // namespace
}  // namespace viewloom::inspect::special_samples_test
