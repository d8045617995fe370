// SPDX-License-Identifier: Apache-2.0
// Portrait photos as frames, against the colours and distances that they were written with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "unit/client/test_files.h"
#include "unit/inputs/written_files.h"
#include "unit/photos/written_photo.h"

namespace viewloom::test::photo_inputs_test {
namespace {

using files::TestFolder;
using inputs::InputKind;
using inputs::InputSettings;
using ::testing::Contains;
using ::testing::HasSubstr;

// Codes. Lossless coding leaves the rounding of Y'CbCr to 8 bits, half a code of each: red moves by
// 0.5 + 1.402 / 2, blue by 0.5 + 1.772 / 2, and all are rounded again.
constexpr int kColorError_codes = 2;

// Relative, of 1/Z as binary32: some operations of 2^-24 each.
constexpr double kInvZError = 1e-6;

class PhotoInputsTest : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string write(const WrittenPhoto& photo) const {
    writePhoto(file("IMG_0001.HEIC"), photo);
    return file("IMG_0001.HEIC");
  }
  inputs::ReadInput read(const WrittenPhoto& photo, const InputSettings& settings = {}) const {
    return readInput(settings, {.color = write(photo)});
  }
  std::string refusal(const WrittenPhoto& photo, const InputSettings& settings = {}) const {
    return refusalOf(settings, {.color = write(photo)});
  }

  const TestFolder folder_;
};

const v1::Plane& planeOf(const inputs::ReadInput& read, int plane) {
  return read.frame.wire.header.sources(0).layers(0).planes(plane);
}

const v1::Intrinsics& intrinsicsOf(const inputs::ReadInput& read) {
  return read.frame.wire.header.sources(0).camera().intrinsics();
}

void expectColor(const inputs::ReadInput& read, uint32_t x, uint32_t y,
                 const std::array<uint8_t, 3>& rgb) {
  const size_t at = 3 * (size_t{y} * planeOf(read, 0).size().width() + x);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR((*read.frame.wire.planes[0])[at + i], rgb[i], kColorError_codes)
        << x << ", " << y << ", channel " << i;
  }
}

void expectInvZ(const inputs::ReadInput& read, uint32_t x, uint32_t y, double inv_z) {
  EXPECT_NEAR(1 / depthAt(read, x, y), inv_z, kInvZError * inv_z) << x << ", " << y;
}

TEST_F(PhotoInputsTest, readsColourAndDisparityOfAPortrait) {
  const auto photo = read(portrait());
  EXPECT_EQ(photo.how.kind, InputKind::kIphone);
  EXPECT_EQ(planeOf(photo, 0).encoding(), v1::PLANE_ENCODING_RGB8);
  EXPECT_EQ(planeOf(photo, 0).size().width(), 192U);
  EXPECT_EQ(planeOf(photo, 0).size().height(), 144U);
  EXPECT_EQ(planeOf(photo, 0).transfer(), v1::COLOR_TRANSFER_SRGB);
  EXPECT_EQ(planeOf(photo, 0).primaries(), v1::COLOR_PRIMARIES_DISPLAY_P3);
  EXPECT_EQ(planeOf(photo, 0).alpha(), v1::ALPHA_MODE_OPAQUE);
  for (uint32_t y = 8; y < 144; y += 16) {
    for (uint32_t x = 8; x < 192; x += 16) expectColor(photo, x, y, blockColor(x, y));
  }
  // 0.25 .. 1.525 of 255 codes: 0.005 each.
  EXPECT_EQ(planeOf(photo, 1).size().width(), 96U);
  EXPECT_EQ(planeOf(photo, 1).size().height(), 72U);
  EXPECT_EQ(photo.frame.code_max.front(), 255U);
  for (uint32_t y = 0; y < 72; y += 5) {
    for (uint32_t x = 0; x < 96; ++x) expectInvZ(photo, x, y, 0.25 + 0.005 * secondCode(x, y));
  }
  EXPECT_THAT(photo.how.notes, Contains("photo: disparity in urn:mpeg:hevc:2015:auxid:2, 0.25 .. "
                                        "1.525 1/m by its XMP, which calls itself relative"));
}

// 26 mm of a film 36 mm wide, as wide as the picture is.
TEST_F(PhotoInputsTest, takesTheFieldOfViewFromExif) {
  const auto photo = read(portrait());
  EXPECT_NEAR(intrinsicsOf(photo).focal_x_px(), 26.0 / 36 * 96, 1e-9) << "in px of the depth";
  EXPECT_NEAR(intrinsicsOf(photo).focal_y_px(), 26.0 / 36 * 96, 1e-9);
  EXPECT_NEAR(intrinsicsOf(photo).principal_x_px(), 48, 1e-9);
  EXPECT_NEAR(intrinsicsOf(photo).principal_y_px(), 36, 1e-9);
  EXPECT_NEAR(intrinsicsOf(read(portrait(), {.fov_y_deg = 90})).focal_y_px(), 36, 1e-9);
  WrittenPhoto nameless = portrait();
  nameless.focal_35mm = 0;
  EXPECT_NEAR(intrinsicsOf(read(nameless)).focal_y_px(), 36 / std::tan(20 * M_PI / 180), 1e-9)
      << "40 degrees without a word";
}

// Held upright, a phone writes what its sensor sees and that it is to be turned.
TEST_F(PhotoInputsTest, turnsColourAndDepthAsTheFileSays) {
  WrittenPhoto upright = portrait();
  upright.orientation = heif_orientation_rotate_90_cw;
  const auto photo = read(upright);
  ASSERT_EQ(planeOf(photo, 0).size().width(), 144U);
  ASSERT_EQ(planeOf(photo, 0).size().height(), 192U);
  ASSERT_EQ(planeOf(photo, 1).size().width(), 72U);
  ASSERT_EQ(planeOf(photo, 1).size().height(), 96U);
  // Its left column, from the bottom, is the top row.
  for (uint32_t y = 8; y < 192; y += 16) {
    for (uint32_t x = 8; x < 144; x += 16) expectColor(photo, x, y, blockColor(y, 143 - x));
  }
  for (uint32_t x = 0; x < 72; x += 3) {
    expectInvZ(photo, x, 7, 0.25 + 0.005 * secondCode(7, 71 - x));
  }
  EXPECT_NEAR(intrinsicsOf(photo).focal_y_px(), 26.0 / 36 * 96, 1e-9) << "36 mm down";
  EXPECT_NEAR(intrinsicsOf(photo).principal_x_px(), 36, 1e-9);
}

// Phones cut the colour into tiles.
TEST_F(PhotoInputsTest, readsImagesOfTiles) {
  WrittenPhoto tiled = portrait();
  tiled.width_px = 64;
  tiled.height_px = 48;
  tiled.second_width_px = 32;
  tiled.second_height_px = 24;
  const auto photo = read(tiled);
  ASSERT_EQ(planeOf(photo, 0).size().height(), 48U);
  ASSERT_EQ(planeOf(photo, 1).size().height(), 24U);
  expectColor(photo, 40, 40, blockColor(40, 40));
  for (uint32_t x = 0; x < 32; ++x) expectInvZ(photo, x, 9, 0.25 + 0.005 * secondCode(x, 9));
}

TEST_F(PhotoInputsTest, letsTheCommandLineOverride) {
  const auto between = read(portrait(), {.near_m = 0.5, .far_m = 4});
  expectInvZ(between, 3, 1, 0.25 + secondCode(3, 1) / 255.0 * 1.75);
  EXPECT_NEAR(depthAt(between, 0, 0), 4, 1e-5);
  const auto scaled = read(portrait(), {.depth_scale = 0.01, .depth_offset = 0.1});
  expectInvZ(scaled, 3, 1, 0.1 + 0.01 * secondCode(3, 1));
  const auto inside_out = read(portrait(), {.is_black_near = true});
  expectInvZ(inside_out, 3, 1, 1.525 - 0.005 * secondCode(3, 1));
  const auto plain_color = read(portrait(), {.primaries = v1::COLOR_PRIMARIES_BT709});
  EXPECT_EQ(planeOf(plain_color, 0).primaries(), v1::COLOR_PRIMARIES_BT709);
  expectInvZ(read(portrait(), {.near_m = 0.5}), 0, 0, 1 / 1.5);  // far is three times near
  EXPECT_THAT(refusal(portrait(), {.near_m = 0.5, .far_m = 0}),
              HasSubstr("--depth-far 0; accepted are"));
  EXPECT_THAT(refusal(portrait(), {.depth_scale = 1, .near_m = 0.5, .far_m = 4}),
              HasSubstr("accepted is either"));
  EXPECT_THAT(refusal(portrait(), {.min_depth = 0.5}),
              HasSubstr("--depth-min has no effect with --input iphone"));
  EXPECT_THAT(refusal(portrait(), {.kind = InputKind::kSensor}),
              HasSubstr("is a photo, which --input sensor cannot read alone"));
}

TEST_F(PhotoInputsTest, readsDistancesInMetres) {
  WrittenPhoto distances = portrait();
  distances.xmp = appleXmp("depth", "0.5", "5.6");
  EXPECT_NEAR(depthAt(read(distances), 3, 1), 0.5 + 0.02 * secondCode(3, 1), 1e-5);
  // Their codes grow away from the camera, linear in Z, between other ends, too.
  const auto between = read(distances, {.near_m = 1, .far_m = 3.55});
  EXPECT_NEAR(depthAt(between, 3, 1), 1 + 0.01 * secondCode(3, 1), 1e-5);
}

TEST_F(PhotoInputsTest, readsDepthRepresentationWhereThereIsNoXmp) {
  WrittenPhoto photo = portrait();
  photo.xmp = "";
  const double share = secondCode(5, 2) / 255.0;
  photo.subtypes = depthRepresentation(0, false, {0.5, 8});
  expectInvZ(read(photo), 5, 2, 0.125 + share * 1.875);
  photo.subtypes = depthRepresentation(1, true, {0.40625, 2.75});
  const auto disparity = read(photo);
  expectInvZ(disparity, 5, 2, 0.40625 + share * 2.34375);
  EXPECT_THAT(disparity.how.notes, Contains(HasSubstr("1/m by its depth representation")));
  photo.subtypes = depthRepresentation(2, false, {0.5, 8});
  EXPECT_NEAR(depthAt(read(photo), 5, 2), 0.5 + share * 7.5, 1e-5);
  photo.xmp = appleXmp("disparity", "0.25", "1.525");
  expectInvZ(read(photo), 5, 2, 0.25 + 0.005 * secondCode(5, 2));
}

TEST_F(PhotoInputsTest, wantsTheNumbersOfCodesWithoutAny) {
  WrittenPhoto photo = portrait();
  for (const std::string& xmp : {std::string(), appleXmp("disparity", "nan", "1"),
                                 appleXmp("disparity", "0.5", "0.5"), std::string("<x:xmpmeta")}) {
    photo.xmp = xmp;
    EXPECT_THAT(refusal(photo),
                HasSubstr("IMG_0001.HEIC: has urn:mpeg:hevc:2015:auxid:2 without the distances of "
                          "its codes; give --depth-near and --depth-far"))
        << xmp;
    EXPECT_NEAR(depthAt(read(photo, {.near_m = 0.5, .far_m = 4}), 0, 0), 4, 1e-5);
  }
}

TEST_F(PhotoInputsTest, readsTenBitDepth) {
  WrittenPhoto photo = portrait();
  photo.second_bits = 10;
  photo.code = [](uint32_t x, uint32_t y) { return static_cast<uint16_t>(10 * x + y); };
  photo.xmp = "";
  photo.subtypes = depthRepresentation(0, false, {0.5, 8});
  const auto deep = read(photo);
  EXPECT_EQ(deep.frame.code_max.front(), 1023U);
  expectInvZ(deep, 30, 20, 0.125 + 320 / 1023.0 * 1.875);
}

// Apple's second images that are no depth, and depth under a name that is not known.
TEST_F(PhotoInputsTest, tellsDepthFromOtherAuxiliaryImages) {
  WrittenPhoto photo = portrait();
  photo.second_type = "urn:com:apple:photo:2018:aux:portraiteffectsmatte";
  photo.xmp = appleXmp("urn:com:apple:photo:2018:aux:portraiteffectsmatte", "0", "1");
  EXPECT_THAT(refusal(photo),
              HasSubstr("has no depth: it holds auxiliary images of "
                        "urn:com:apple:photo:2018:aux:portraiteffectsmatte; take it in portrait "
                        "mode, or give --depth FILE beside it"));
  photo.second_type = "urn:com:apple:photo:2018:aux:disparity";
  photo.xmp = appleXmp("disparity", "0.25", "1.525");
  expectInvZ(read(photo), 3, 1, 0.25 + 0.005 * secondCode(3, 1));
  photo.xmp = "";
  EXPECT_THAT(refusal(photo), HasSubstr("has no depth"));
  photo.has_second = false;
  EXPECT_THAT(refusal(photo), HasSubstr("has no depth: it holds no auxiliary image; take it"));
}

TEST_F(PhotoInputsTest, takesDepthOfAFileBesideIt) {
  writePng(file("depth.png"), 4, 3, 1, 16, std::vector<uint16_t>(12, 1500));
  const inputs::InputFiles files{.color = write(portrait()), .depth = file("depth.png")};
  const auto photo = readInput({.kind = InputKind::kSensor}, files);
  EXPECT_NEAR(depthAt(photo, 1, 1), 1.5, 1e-6);
  expectColor(photo, 40, 24, blockColor(40, 24));
  EXPECT_EQ(planeOf(photo, 0).primaries(), v1::COLOR_PRIMARIES_DISPLAY_P3);
  EXPECT_NEAR(intrinsicsOf(photo).focal_x_px(), 26.0 / 36 * 4, 1e-9);
  const auto codes = readInput({.kind = InputKind::kIphone, .near_m = 1, .far_m = 65535}, files);
  EXPECT_NEAR(1 / depthAt(codes, 1, 1), 1500.0 / 65535, 1e-4);
}

TEST_F(PhotoInputsTest, readsPrimariesOfProfiles) {
  WrittenPhoto photo = portrait();
  const auto primariesOf = [&] { return planeOf(read(photo), 0).primaries(); };
  // IEC 61966-2.1's profile, and that of BT.2020.
  photo.icc = iccProfile(
      {{{0.43607, 0.22249, 0.01392}, {0.38515, 0.71687, 0.09708}, {0.14307, 0.06061, 0.7141}}});
  EXPECT_EQ(primariesOf(), v1::COLOR_PRIMARIES_BT709);
  photo.icc = iccProfile(
      {{{0.67346, 0.27904, -0.00194}, {0.16566, 0.67534, 0.02998}, {0.1251, 0.0456, 0.7969}}});
  EXPECT_EQ(primariesOf(), v1::COLOR_PRIMARIES_BT2020);
  // Adobe RGB.
  photo.icc = iccProfile(
      {{{0.60974, 0.31111, 0.01947}, {0.20528, 0.62567, 0.06087}, {0.14919, 0.06322, 0.74457}}});
  const auto foreign = read(photo);
  EXPECT_EQ(planeOf(foreign, 0).primaries(), v1::COLOR_PRIMARIES_BT709);
  EXPECT_THAT(foreign.how.notes, Contains(HasSubstr("primaries of its colour profile are none")));
  photo.icc = {};
  photo.nclx_primaries = 12;
  EXPECT_EQ(primariesOf(), v1::COLOR_PRIMARIES_DISPLAY_P3);
  photo.nclx_primaries = 9;
  EXPECT_EQ(primariesOf(), v1::COLOR_PRIMARIES_BT2020);
  photo.nclx_primaries = 5;
  EXPECT_THAT(read(photo).how.notes, Contains(HasSubstr("primaries of its colour profile")));
  photo.nclx_primaries = 2;
  EXPECT_EQ(primariesOf(), v1::COLOR_PRIMARIES_BT709);
}

}  // namespace
}  // namespace viewloom::test::photo_inputs_test
