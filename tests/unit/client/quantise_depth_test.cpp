// SPDX-License-Identifier: Apache-2.0
// Against what samples mean in double precision (support/depth_reference), before and after.
#include "lib/quantise_depth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "frame/cube_map.h"
#include "support/depth_reference.h"

namespace viewloom::quantise_depth_test {
namespace {

using testing::HasSubstr;

constexpr uint32_t kWidth = 24;
constexpr uint32_t kHeight = 18;
constexpr Intrinsics kIntrinsics{.focal_px = {20, 22}, .principal_px = {11, 9.5}};
constexpr float kInf = std::numeric_limits<float>::infinity();

struct TestSource {
  v1::Source source;
  std::vector<SharedBytes> planes;
};

SharedBytes bytesOf(const std::vector<float>& samples) {
  std::vector<uint8_t> bytes(samples.size() * sizeof(float));
  std::memcpy(bytes.data(), samples.data(), bytes.size());
  return std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
}

v1::DepthFormat formatOf(v1::DepthMeaning meaning) {
  v1::DepthFormat format;
  format.set_meaning(meaning);
  return format;
}

// A layer of colour and of depth.
void addLayer(const v1::DepthFormat& format, const std::vector<float>& samples, TestSource& to,
              uint32_t height = kHeight) {
  v1::Layer& layer = *to.source.add_layers();
  v1::Plane& color = *layer.add_planes();
  color.set_kind(v1::PLANE_KIND_COLOR);
  color.set_encoding(v1::PLANE_ENCODING_RGB8);
  to.planes.push_back(std::make_shared<const std::vector<uint8_t>>(3));
  v1::Plane& depth = *layer.add_planes();
  depth.set_kind(v1::PLANE_KIND_DEPTH);
  depth.set_encoding(v1::PLANE_ENCODING_DEPTH_F32);
  depth.mutable_size()->set_width(kWidth);
  depth.mutable_size()->set_height(height);
  depth.set_bytes_count(samples.size() * sizeof(float));
  *depth.mutable_depth() = format;
  to.planes.push_back(bytesOf(samples));
}

TestSource sourceOf(const v1::DepthFormat& format, const std::vector<float>& samples) {
  TestSource source;
  v1::Intrinsics& intrinsics = *source.source.mutable_camera()->mutable_intrinsics();
  intrinsics.set_focal_x_px(kIntrinsics.focal_px.x);
  intrinsics.set_focal_y_px(kIntrinsics.focal_px.y);
  intrinsics.set_principal_x_px(kIntrinsics.principal_px.x);
  intrinsics.set_principal_y_px(kIntrinsics.principal_px.y);
  addLayer(format, samples, source);
  return source;
}

std::vector<float> samplesBetween(float least, float most, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(least, most);
  std::vector<float> samples(kWidth * kHeight);
  for (float& sample : samples) sample = value(random);
  return samples;
}

DepthFormat asDepthFormat(const v1::DepthFormat& proto) {
  DepthFormat format{.meaning = static_cast<DepthMeaning>(proto.meaning() - 1),
                     .scale = proto.scale() == 0 ? 1 : proto.scale(),
                     .offset = proto.offset(),
                     .near_z_m = proto.near_z_m(),
                     .far_z_m = proto.far_z_m(),
                     .invalid_is_far = proto.invalid_is_far()};
  if (proto.has_invalid_value()) format.invalid_value = proto.invalid_value();
  return format;
}

// Decoded depth of sample `i` of a plane.
DepthValue valueAt(const v1::Plane& plane, const SharedBytes& bytes, size_t i, uint32_t image_rows,
                   const Intrinsics& intrinsics) {
  const glm::uvec2 pixel_px(i % kWidth, i / kWidth % image_rows);
  if (plane.encoding() == v1::PLANE_ENCODING_DEPTH_U16) {
    const double sample = (*bytes)[2 * i] + 256.0 * (*bytes)[2 * i + 1];
    return linearizeDepth(asDepthFormat(plane.depth()), PlaneEncoding::kDepthU16, sample, pixel_px,
                          intrinsics);
  }
  float sample = 0;
  std::memcpy(&sample, bytes->data() + i * sizeof(sample), sizeof(sample));
  return linearizeDepth(asDepthFormat(plane.depth()), PlaneEncoding::kDepthF32, double{sample},
                        pixel_px, intrinsics);
}

// Every surface within half a step of itself, the sky where it was, nothing where nothing was.
void expectWithinHalfAStep(const TestSource& was, const TestSource& is, double step,
                           const Intrinsics& intrinsics = kIntrinsics) {
  for (int l = 0; l < was.source.layers_size(); ++l) {
    const v1::Plane& before = was.source.layers(l).planes(1);
    const v1::Plane& after = is.source.layers(l).planes(1);
    const auto p = static_cast<size_t>(2 * l + 1);
    const uint32_t image_rows = before.size().height() / (was.source.cube_map() ? 6 : 1);
    ASSERT_EQ(after.encoding(), v1::PLANE_ENCODING_DEPTH_U16);
    ASSERT_EQ(after.bytes_count(), is.planes[p]->size());
    ASSERT_EQ(is.planes[p]->size(), size_t{2} * kWidth * before.size().height());
    for (size_t i = 0; i < is.planes[p]->size() / 2; ++i) {
      const DepthValue a = valueAt(before, was.planes[p], i, image_rows, intrinsics);
      const DepthValue b = valueAt(after, is.planes[p], i, image_rows, intrinsics);
      ASSERT_EQ(a.kind == DepthClass::kSurface, b.kind == DepthClass::kSurface) << i;
      ASSERT_NE(b.kind, DepthClass::kBad) << i;
      if (a.kind != DepthClass::kSurface) continue;
      // Beyond half a step: 1/Z itself is computed in binary32.
      ASSERT_LE(std::abs(a.inv_z - b.inv_z), 0.5 * step + a.inv_z * 0x1p-22) << i;
      if (a.inv_z == 0) {
        ASSERT_EQ(b.inv_z, 0) << i;
      }
    }
  }
}

TEST(QuantiseDepth, keepsEveryMeaningWithinHalfAStep) {
  v1::DepthFormat window = formatOf(v1::DEPTH_MEANING_WINDOW);  // reversed, infinite
  window.set_near_z_m(kInf);
  window.set_far_z_m(0.5);
  v1::DepthFormat millimetres = formatOf(v1::DEPTH_MEANING_PLANAR);
  millimetres.set_scale(0.001);
  const std::pair<v1::DepthFormat, std::vector<float>> cases[] = {
      {formatOf(v1::DEPTH_MEANING_PLANAR), samplesBetween(0.5, 40, 1)},
      {millimetres, samplesBetween(500, 40000, 2)},
      {formatOf(v1::DEPTH_MEANING_RAY_DISTANCE), samplesBetween(0.5, 40, 3)},
      {formatOf(v1::DEPTH_MEANING_DISPARITY), samplesBetween(0.2F, 0.3F, 4)},
      {window, samplesBetween(0, 1, 5)}};
  for (const auto& [format, samples] : cases) {
    SCOPED_TRACE(v1::DepthMeaning_Name(format.meaning()));
    const TestSource was = sourceOf(format, samples);
    TestSource is = was;
    const QuantisedDepth depth = quantiseDepth(is.source, is.planes);
    EXPECT_EQ(depth.kept_because, "");
    EXPECT_EQ(is.source.layers(0).planes(1).depth().scale(), depth.step);
    EXPECT_LE(depth.step, depth.step_max);
    EXPECT_LT(depth.step, 2.0 / 65000 * 1.01) << "the range is no more than 0..2 1/m";
    expectWithinHalfAStep(was, is, depth.step);
  }
}

TEST(QuantiseDepth, keepsTheSkyExactAndWhatIsNoSurface) {
  std::vector<float> samples = samplesBetween(1, 30, 6);
  for (size_t i = 0; i < samples.size(); i += 5) samples[i] = kInf;
  samples[1] = 0;
  samples[2] = std::nanf("");
  samples[3] = -2;
  samples[4] = 7;
  v1::DepthFormat format = formatOf(v1::DEPTH_MEANING_PLANAR);
  format.set_invalid_value(7);
  for (const bool is_far : {false, true}) {
    format.set_invalid_is_far(is_far);
    const TestSource was = sourceOf(format, samples);
    TestSource is = was;
    expectWithinHalfAStep(was, is, quantiseDepth(is.source, is.planes).step);
  }
}

TEST(QuantiseDepth, takesSurfacesBesideTheSkyForNoBadSamples) {
  // So near to 0 that a code of theirs could fall below it.
  std::vector<float> samples(kWidth * kHeight, 0.5F);
  for (size_t i = 0; i < samples.size(); i += 3) samples[i] = 1e-9F;
  const TestSource was = sourceOf(formatOf(v1::DEPTH_MEANING_DISPARITY), samples);
  TestSource is = was;
  expectWithinHalfAStep(was, is, quantiseDepth(is.source, is.planes).step);
}

TEST(QuantiseDepth, givesAllLayersOneGrid) {
  TestSource was = sourceOf(formatOf(v1::DEPTH_MEANING_PLANAR), samplesBetween(0.5, 4, 7));
  addLayer(formatOf(v1::DEPTH_MEANING_DISPARITY), samplesBetween(0.01F, 0.1F, 8), was);
  TestSource is = was;
  expectWithinHalfAStep(was, is, quantiseDepth(is.source, is.planes).step);
  const v1::DepthFormat& front = is.source.layers(0).planes(1).depth();
  const v1::DepthFormat& back = is.source.layers(1).planes(1).depth();
  EXPECT_EQ(front.SerializeAsString(), back.SerializeAsString());
}

TEST(QuantiseDepth, measuresRaysOfCubeMapsInTheirFaces) {
  TestSource was;
  was.source.set_cube_map(true);
  std::vector<float> samples;
  for (uint32_t face = 0; face < 6; ++face) {
    std::vector<float> more = samplesBetween(1, 20, 20 + face);
    more.resize(kWidth * kWidth, 3);
    samples.insert(samples.end(), more.begin(), more.end());
  }
  addLayer(formatOf(v1::DEPTH_MEANING_RAY_DISTANCE), samples, was, 6 * kWidth);
  TestSource is = was;
  const QuantisedDepth depth = quantiseDepth(is.source, is.planes);
  EXPECT_EQ(depth.kept_because, "");
  expectWithinHalfAStep(was, is, depth.step, cubeFaceIntrinsics(kWidth));
}

TEST(QuantiseDepth, takesPlanesOfOneValueOfSkyAndOfNothing) {
  for (const float sample : {2.0F, kInf, 0.0F}) {
    const TestSource was =
        sourceOf(formatOf(v1::DEPTH_MEANING_PLANAR), std::vector<float>(kWidth * kHeight, sample));
    TestSource is = was;
    const QuantisedDepth depth = quantiseDepth(is.source, is.planes);
    EXPECT_EQ(depth.kept_because, "") << sample;
    EXPECT_GT(depth.step, 0) << sample;
    expectWithinHalfAStep(was, is, depth.step);
  }
}

TEST(QuantiseDepth, stripsStrides) {
  const std::vector<float> samples = samplesBetween(1, 9, 9);
  const TestSource packed = sourceOf(formatOf(v1::DEPTH_MEANING_PLANAR), samples);
  TestSource is = packed;
  std::vector<float> padded;
  for (size_t i = 0; i < samples.size(); ++i) {
    padded.push_back(samples[i]);
    if (i % kWidth == kWidth - 1) padded.insert(padded.end(), {-1, 99});
  }
  is.planes[1] = bytesOf(padded);
  is.source.mutable_layers(0)->mutable_planes(1)->set_stride_bytes((kWidth + 2) * 4);
  const QuantisedDepth depth = quantiseDepth(is.source, is.planes);
  EXPECT_EQ(is.source.layers(0).planes(1).stride_bytes(), 0U);
  expectWithinHalfAStep(packed, is, depth.step);
}

void expectKept(const TestSource& was, const char* reason) {
  TestSource is = was;
  const QuantisedDepth depth = quantiseDepth(is.source, is.planes);
  EXPECT_THAT(depth.kept_because, HasSubstr(reason));
  EXPECT_EQ(depth.step, 0);
  EXPECT_EQ(is.planes, was.planes);
  EXPECT_EQ(is.source.SerializeAsString(), was.source.SerializeAsString());
}

TEST(QuantiseDepth, keepsDepthWhoseRangeIsTooWideForSixteenBits) {
  std::vector<float> samples = samplesBetween(1, 4, 10);
  samples[40] = 0.0005F;  // a speck before the lens: 2000 1/m
  expectKept(sourceOf(formatOf(v1::DEPTH_MEANING_PLANAR), samples), "16 bits from ");
  samples[40] = 0.05F;
  TestSource is = sourceOf(formatOf(v1::DEPTH_MEANING_PLANAR), samples);
  const QuantisedDepth depth = quantiseDepth(is.source, is.planes);
  EXPECT_EQ(depth.kept_because, "");
  // The middle of the 2nd and the 98th percentile of 1/Z, seen at 1000 px.
  EXPECT_NEAR(depth.step_max, 0.5 * (1 / 3.94 + 1 / 1.06) / 1000, 3e-5);
}

TEST(QuantiseDepth, keepsWhatNoServerTakes) {
  const std::vector<float> samples = samplesBetween(1, 4, 11);
  expectKept(sourceOf(formatOf(v1::DEPTH_MEANING_UNSPECIFIED), samples), "incomplete");
  expectKept(sourceOf(formatOf(v1::DEPTH_MEANING_WINDOW), samples), "incomplete");
  TestSource no_camera = sourceOf(formatOf(v1::DEPTH_MEANING_PLANAR), samples);
  no_camera.source.clear_camera();
  expectKept(no_camera, "incomplete");
  TestSource short_plane = sourceOf(formatOf(v1::DEPTH_MEANING_PLANAR), samples);
  short_plane.planes[1] = bytesOf(std::vector<float>(7, 1));
  expectKept(short_plane, "incomplete");
}

TEST(QuantiseDepth, leavesOtherEncodingsAlone) {
  TestSource half = sourceOf(formatOf(v1::DEPTH_MEANING_PLANAR), samplesBetween(1, 4, 12));
  half.source.mutable_layers(0)->mutable_planes(1)->set_encoding(v1::PLANE_ENCODING_DEPTH_F16);
  expectKept(half, "");
  TestSource packed = sourceOf(formatOf(v1::DEPTH_MEANING_PLANAR), samplesBetween(1, 4, 12));
  packed.source.mutable_layers(0)->mutable_planes(1)->set_compression(v1::PLANE_COMPRESSION_ZSTD);
  expectKept(packed, "");
}

}  // namespace
}  // namespace viewloom::quantise_depth_test
