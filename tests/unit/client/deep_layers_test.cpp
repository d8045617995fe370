// SPDX-License-Identifier: Apache-2.0
#include "files/deep_layers.h"

#include <Imath/half.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "deep/tidy_pixel.h"
#include "support/deep_composite.h"
#include "support/deep_exr_writer.h"
#include "unit/client/test_files.h"

namespace viewloom::files::deep_layers_test {
namespace {

using deep::DeepSample;
using Imath::Box2i;
using Imath::V2i;
using test::DeepPicture;
using test::DeepPixel;
using ::testing::HasSubstr;

DeepSample surface(float z_m, float alpha, const glm::vec3& color) {
  return {.z_m = z_m, .z_back_m = z_m, .alpha = alpha, .color = alpha * color};
}

Box2i boxOf(int width, int height) {
  return {V2i(0, 0), V2i(width - 1, height - 1)};
}

float depthOf(const DeepLayers& layers, size_t layer, size_t pixel) {
  float depth_m = 0;
  std::memcpy(&depth_m, &layers.planes[2 * layer + 1].bytes->at(4 * pixel), 4);
  return depth_m;
}

glm::dvec4 colorOf(const DeepLayers& layers, size_t layer, size_t pixel) {
  glm::dvec4 color;
  for (int i = 0; i < 4; ++i) {
    uint16_t bits = 0;
    std::memcpy(&bits, &layers.planes[2 * layer].bytes->at(8 * pixel + 2 * size_t(i)), 2);
    color[i] = Imath::half(Imath::half::FromBits, bits);
  }
  return color;
}

class DeepLayersTest : public ::testing::Test {
 protected:
  DeepLayersTest() { options_.mutable_depth()->set_meaning(v1::DEPTH_MEANING_PLANAR); }

  // A picture of one row.
  absl::StatusOr<DeepLayers> load(const std::vector<DeepPixel>& pixels) {
    const Box2i box = boxOf(static_cast<int>(pixels.size()), 1);
    return load({.data = box, .display = box, .pixels = pixels});
  }
  absl::StatusOr<DeepLayers> load(const DeepPicture& picture) {
    test::writeDeepExr(folder_.path() / "deep.exr", picture, {});
    options_.set_file("deep.exr");
    return loadDeepLayers(options_, folder_.path());
  }
  std::string refusal() const {
    return std::string(loadDeepLayers(options_, folder_.path()).status().message());
  }

  v1::DeepFile options_;
  TestFolder folder_;
};

// ACEScg's red at D60 is far outside Rec.709; grey stays grey.
TEST_F(DeepLayersTest, convertsColourOfUnknownChromaticities) {
  const Box2i box = boxOf(2, 1);
  const Imf::Chromaticities ap1({0.713F, 0.293F}, {0.165F, 0.83F}, {0.128F, 0.044F},
                                {0.32168F, 0.33767F});
  test::writeDeepExr(
      folder_.path() / "deep.exr",
      {.data = box,
       .display = box,
       .pixels = {{surface(2, 0.5F, {0.5F, 0.5F, 0.5F})}, {surface(2, 1, {1, 0, 0})}}},
      {.chromaticities = ap1});
  options_.set_file("deep.exr");
  const auto layers = loadDeepLayers(options_, folder_.path());
  ASSERT_TRUE(layers.ok()) << layers.status();
  EXPECT_EQ(layers->planes[0].plane.primaries(), v1::COLOR_PRIMARIES_BT2020);
  const glm::dvec4 grey = colorOf(*layers, 0, 0), red = colorOf(*layers, 0, 1);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(grey[i], 0.25, 0.001);
  EXPECT_NEAR(grey.a, 0.5, 0.001);
  // Computed apart, from the definitions of both spaces and Bradford's adaptation.
  EXPECT_NEAR(red.r, 1.0258, 0.002);
  EXPECT_NEAR(red.g, -0.0022, 0.002);
  EXPECT_NEAR(red.b, -0.0050, 0.002);
  options_.set_primaries(v1::COLOR_PRIMARIES_BT709);
  EXPECT_EQ(colorOf(*loadDeepLayers(options_, folder_.path()), 0, 1).r, 1) << "as it is told";
}

TEST_F(DeepLayersTest, putsEverySurfaceInALayerOfItsOwn) {
  const auto layers = load(std::vector<DeepPixel>{
      {surface(4, 1, {0, 0, 1}), surface(2, 0.5F, {1, 0.5F, 0})}, {surface(8, 1, {0, 1, 0})}, {}});
  ASSERT_TRUE(layers.ok()) << layers.status();
  ASSERT_EQ(layers->planes.size(), 4U) << "two layers are all it needs";
  const v1::Plane& color = layers->planes[0].plane;
  EXPECT_EQ(color.kind(), v1::PLANE_KIND_COLOR);
  EXPECT_EQ(color.encoding(), v1::PLANE_ENCODING_RGBA16F);
  EXPECT_EQ(color.transfer(), v1::COLOR_TRANSFER_LINEAR);
  EXPECT_EQ(color.alpha(), v1::ALPHA_MODE_PREMULTIPLIED);
  EXPECT_EQ(color.bytes_count(), 3U * 8);
  const v1::Plane& depth = layers->planes[1].plane;
  EXPECT_EQ(depth.kind(), v1::PLANE_KIND_DEPTH);
  EXPECT_EQ(depth.encoding(), v1::PLANE_ENCODING_DEPTH_F32);
  EXPECT_EQ(depth.depth().meaning(), v1::DEPTH_MEANING_PLANAR);
  EXPECT_EQ(depth.size().width(), 3U);

  EXPECT_EQ(depthOf(*layers, 0, 0), 2);
  EXPECT_EQ(depthOf(*layers, 1, 0), 4);
  EXPECT_EQ(colorOf(*layers, 0, 0), glm::dvec4(0.5, 0.25, 0, 0.5));
  EXPECT_EQ(colorOf(*layers, 1, 0), glm::dvec4(0, 0, 1, 1));
  EXPECT_EQ(depthOf(*layers, 0, 1), 8);
  EXPECT_EQ(depthOf(*layers, 1, 1), 0) << "no surface";
  EXPECT_EQ(depthOf(*layers, 0, 2), 0);
  EXPECT_EQ(layers->report.layer_count, 2U);
  EXPECT_EQ(layers->report.pixel_count, 2U);
  EXPECT_EQ(layers->report.sample_count, 3U);
  EXPECT_EQ(layers->report.samples_per_px_max, 2U);
  EXPECT_EQ(layers->report.mergedShare(), 0);
  EXPECT_EQ(layers->report.error_max_per_m, 0);
}

TEST_F(DeepLayersTest, reportsWhatMergingCosts) {
  options_.set_layers(1);
  options_.mutable_depth()->set_meaning(v1::DEPTH_MEANING_RAY_DISTANCE);
  options_.mutable_depth()->set_scale(0.01);  // the file is in centimetres
  const auto layers =
      load(std::vector<DeepPixel>{{surface(100, 0.5F, {1, 1, 1}), surface(200, 1, {1, 1, 1})},
                                  {surface(100, 1, {1, 1, 1}), surface(-1, 1, {1, 1, 1})},
                                  {},
                                  {surface(300, 1, {0, 0, 0})}});
  ASSERT_TRUE(layers.ok()) << layers.status();
  EXPECT_EQ(layers->planes[1].plane.depth().meaning(), v1::DEPTH_MEANING_RAY_DISTANCE);
  EXPECT_EQ(layers->planes[1].plane.depth().scale(), 0) << "metres, as they are";
  EXPECT_EQ(colorOf(*layers, 0, 0), glm::dvec4(1, 1, 1, 1));
  // Half at 1/Z = 1, half at 1/2: all at 3/4, each 1/4 off.
  EXPECT_NEAR(depthOf(*layers, 0, 0), 4.0 / 3, 1e-6);
  EXPECT_NEAR(layers->report.error_max_per_m, 0.25, 1e-6);
  EXPECT_NEAR(layers->report.error_mean_per_m, 0.25 / 3, 1e-6);
  EXPECT_NEAR(layers->report.mergedShare(), 1.0 / 3, 1e-12);
  EXPECT_EQ(layers->report.dropped_sample_count, 1U);
}

TEST_F(DeepLayersTest, compositesToTheFlatPicture) {
  const unsigned seed = 64;
  std::mt19937 random(seed);
  const auto chance = [&] { return std::uniform_real_distribution<float>(0, 1)(random); };
  const Box2i box = boxOf(40, 25);
  DeepPicture picture{.data = box, .display = box, .pixels = std::vector<DeepPixel>(1000)};
  for (DeepPixel& pixel : picture.pixels) {
    pixel.resize(random() % 12);
    for (DeepSample& sample : pixel) {
      sample = surface(0.5F + 9 * chance(), random() % 6 == 0 ? 1 : 0.4F * chance(),
                       {chance(), chance(), chance()});
      if (random() % 3 == 0) sample.z_back_m += chance();
    }
  }
  for (const uint32_t layer_count_max : {1U, 2U, 3U, 4U}) {
    options_.set_layers(layer_count_max);
    const auto layers = load(picture);
    ASSERT_TRUE(layers.ok()) << layers.status();
    EXPECT_EQ(layers->report.layer_count, layer_count_max);
    deep::PixelTidier tidier;
    for (size_t pixel = 0; pixel < picture.pixels.size(); ++pixel) {
      const glm::dvec4 wanted = deep::compositeOf(tidier.tidy(picture.pixels[pixel]));
      glm::dvec4 got(0);
      for (size_t i = 0; i < layer_count_max; ++i) {
        got += (1 - got.a) * colorOf(*layers, i, pixel);
      }
      // Each layer's light and alpha, at most 1, are off by half a step of binary16 below 1.
      constexpr double kHalfRounding = 1.0 / 4096;
      for (int i = 0; i < 4; ++i) {
        ASSERT_NEAR(got[i], wanted[i], 2 * layer_count_max * kHalfRounding) << seed << pixel;
      }
    }
  }
}

TEST_F(DeepLayersTest, putsABlackSkyBehindWhatLetsLightThrough) {
  options_.set_black_sky(true);
  const auto layers = load({.data = boxOf(2, 1),
                            .display = boxOf(3, 1),
                            .pixels = {{surface(2, 0.5F, {1, 1, 1})}, {surface(2, 1, {1, 1, 1})}}});
  ASSERT_TRUE(layers.ok()) << layers.status();
  ASSERT_EQ(layers->report.layer_count, 2U);
  EXPECT_EQ(depthOf(*layers, 1, 0), INFINITY);
  EXPECT_EQ(colorOf(*layers, 1, 0), glm::dvec4(0, 0, 0, 1));
  EXPECT_EQ(depthOf(*layers, 1, 1), 0) << "nothing behind what is opaque";
  EXPECT_EQ(depthOf(*layers, 0, 2), INFINITY) << "also where the file has no data";
}

TEST_F(DeepLayersTest, hasALayerWhateverIsInTheFile) {
  const auto layers = load(std::vector<DeepPixel>(3));
  ASSERT_TRUE(layers.ok()) << layers.status();
  EXPECT_EQ(layers->planes.size(), 2U);
  EXPECT_EQ(layers->report.mergedShare(), 0);
  EXPECT_EQ(layers->report.error_mean_per_m, 0);
}

TEST_F(DeepLayersTest, refusesByFieldAndFile) {
  EXPECT_THAT(refusal(), HasSubstr("is a folder"));
  options_.set_file("missing.exr");
  EXPECT_THAT(refusal(), HasSubstr("no such file"));
  options_.set_layers(5);
  EXPECT_THAT(refusal(), HasSubstr("layers: is 5; accepted is 1..4"));
  options_.set_layers(0);
  options_.mutable_depth()->set_scale(NAN);
  EXPECT_THAT(refusal(), HasSubstr("depth.scale: and offset must be finite"));
  options_.mutable_depth()->set_scale(0);
  options_.mutable_depth()->set_invalid_value(0);
  EXPECT_THAT(refusal(), HasSubstr("depth.invalid_value: is given"));
  options_.mutable_depth()->set_meaning(v1::DEPTH_MEANING_WINDOW);
  EXPECT_THAT(refusal(), HasSubstr("depth.meaning: is DEPTH_MEANING_WINDOW; accepted for deep"));
}

TEST_F(DeepLayersTest, refusesMoreThanAFrameMayHold) {
  const auto layers =
      load({.data = boxOf(1, 1), .display = boxOf(8192, 8192), .pixels = {DeepPixel()}});
  EXPECT_THAT(std::string(layers.status().message()),
              HasSubstr("would take 3221225472 bytes as 4 layers; accepted are up to 1610612736"));
}

}  // namespace
}  // namespace viewloom::files::deep_layers_test
