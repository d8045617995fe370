// SPDX-License-Identifier: Apache-2.0
// Cameras and primaries of OpenEXR headers, made of matrices written by hand.
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include <Imath/half.h>

#include "unit/client/test_files.h"
#include "unit/inputs/written_files.h"

namespace viewloom::test::exr_camera_test {
namespace {

using files::TestFolder;
using Imath::M44f;
using Imath::V2f;
using ::testing::HasSubstr;

std::vector<WrittenChannel> whiteAtTwoMetres() {
  const auto constant = [](const char* name, float value) {
    return WrittenChannel{name, Imf::FLOAT, [value](int, int) { return value; }};
  };
  return {constant("R", 1), constant("G", 0.5F), constant("B", 0.25F), constant("Z", 2)};
}

class ExrCameraTest : public ::testing::Test {
 protected:
  void write(const std::function<void(Imf::Header&)>& edit) {
    writeExr(path_, 32, 16, whiteAtTwoMetres(), edit);
  }
  v1::Camera camera(const inputs::InputSettings& settings = {}) {
    return readInput(settings, {.color = path_}).frame.wire.header.sources(0).camera();
  }

  const TestFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "camera.exr";
};

// The world is right-handed with y up; the camera stands at (1, 2, 3) and looks along -z, which is
// the +z of its own left-handed space: vectors are rows.
const M44f kMirrored(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, -1, -2, 3, 1);

TEST_F(ExrCameraTest, standsWhereWorldToCameraSays) {
  write([](Imf::Header& header) { Imf::addWorldToCamera(header, kMirrored); });
  const v1::Camera found = camera({.fov_y_deg = 90});
  EXPECT_NEAR(found.pose().position().x(), 1, 1e-6);
  EXPECT_NEAR(found.pose().position().y(), 2, 1e-6);
  EXPECT_NEAR(found.pose().position().z(), 3, 1e-6);
  EXPECT_NEAR(std::abs(found.pose().orientation().w()), 1, 1e-6);
  EXPECT_NEAR(found.intrinsics().focal_y_px(), 8, 1e-9);
}

TEST_F(ExrCameraTest, takesAWorldOfTheCamerasHandednessAsLeftHanded) {
  M44f shifted;
  shifted.setTranslation(Imath::V3f(-1, -2, -3));  // the camera stands at (1, 2, 3), +z forward
  write([&](Imf::Header& header) { Imf::addWorldToCamera(header, shifted); });
  EXPECT_NEAR(camera().pose().position().z(), -3, 1e-6);
  // The same numbers of a tool whose cameras look along -z.
  const v1::Camera found = camera({.looks_along_minus_z = true});
  EXPECT_NEAR(found.pose().position().z(), 3, 1e-6);
  EXPECT_NEAR(std::abs(found.pose().orientation().w()), 1, 1e-6);
}

TEST_F(ExrCameraTest, countsItsPlaceInTheUnitOfDepth) {
  write([](Imf::Header& header) { Imf::addWorldToCamera(header, kMirrored); });
  EXPECT_NEAR(camera({.depth_scale = 0.01}).pose().position().y(), 0.02, 1e-9);
}

// 0..1 from the upper left: x = 0.25 + x_camera / z_camera, y = 0.5 - 2 y_camera / z_camera.
TEST_F(ExrCameraTest, hasTheFieldOfViewOfWorldToNdc) {
  const M44f ndc_from_camera(1, 0, 0, 0, 0, -2, 0, 0, 0.25F, 0.5F, 1, 1, 0, 0, -1, 0);
  write([&](Imf::Header& header) {
    Imf::addWorldToCamera(header, kMirrored);
    Imf::addWorldToNDC(header, kMirrored * ndc_from_camera);
  });
  const v1::Camera found = camera();
  EXPECT_NEAR(found.intrinsics().focal_x_px(), 32, 1e-4);
  EXPECT_NEAR(found.intrinsics().focal_y_px(), 32, 1e-4);
  EXPECT_NEAR(found.intrinsics().principal_x_px(), 8, 1e-4);
  EXPECT_NEAR(found.intrinsics().principal_y_px(), 8, 1e-4);
}

// -1..1 from the lower left, as projection matrices of graphics libraries give it.
TEST_F(ExrCameraTest, readsAWorldToNdcAroundTheMiddle) {
  const M44f ndc_from_camera(2, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1, 1, 0, 0, -1, 0);
  write([&](Imf::Header& header) {
    Imf::addWorldToCamera(header, kMirrored);
    Imf::addWorldToNDC(header, kMirrored * ndc_from_camera);
  });
  const v1::Camera found = camera();
  EXPECT_NEAR(found.intrinsics().focal_x_px(), 32, 1e-4);
  EXPECT_NEAR(found.intrinsics().focal_y_px(), 32, 1e-4);
  EXPECT_NEAR(found.intrinsics().principal_x_px(), 16, 1e-4);
  EXPECT_NEAR(found.intrinsics().principal_y_px(), 8, 1e-4);
}

TEST_F(ExrCameraTest, refusesMatricesThatAreNoCameras) {
  M44f nan = kMirrored, scaled = kMirrored, flat = kMirrored;
  nan[3][0] = std::numeric_limits<float>::quiet_NaN();
  scaled[0][0] = 3;
  for (int i = 0; i < 4; ++i) flat[1][i] = 0;
  for (const M44f& matrix : {nan, scaled, flat}) {
    write([&](Imf::Header& header) { Imf::addWorldToCamera(header, matrix); });
    EXPECT_THAT(refusalOf({}, {.color = path_}), HasSubstr("worldToCamera is no turn and shift"));
    EXPECT_EQ(refusalOf({.kind = inputs::InputKind::kPlain}, {.color = path_}), "OK");
  }
  write([&](Imf::Header& header) {
    Imf::addWorldToCamera(header, kMirrored);
    Imf::addWorldToNDC(header, M44f());
  });
  EXPECT_THAT(refusalOf({}, {.color = path_}), HasSubstr("worldToNDC is no pinhole's"));
}

TEST_F(ExrCameraTest, hasTheShapeOfItsPx) {
  write([](Imf::Header& header) { header.pixelAspectRatio() = 2; });
  const v1::Intrinsics found = camera({.focal_px = 20}).intrinsics();
  EXPECT_EQ(found.focal_x_px(), 10);
  EXPECT_EQ(found.focal_y_px(), 20);
  // Every second row was left out: the columns have kept their focal length.
  write([](Imf::Header& header) { header.pixelAspectRatio() = 0.5F; });
  const v1::Intrinsics halved = camera({.focal_px = 20}).intrinsics();
  EXPECT_EQ(halved.focal_x_px(), 20);
  EXPECT_EQ(halved.focal_y_px(), 10);
}

class ExrPrimariesTest : public ExrCameraTest {
 protected:
  void write(const Imf::Chromaticities& chromaticities) {
    ExrCameraTest::write(
        [&](Imf::Header& header) { Imf::addChromaticities(header, chromaticities); });
  }
  v1::ColorPrimaries primaries(const inputs::InputSettings& settings = {}) {
    read_ = readInput(settings, {.color = path_}).frame;
    return read_.wire.header.sources(0).layers(0).planes(0).primaries();
  }
  float channel(size_t index) const {
    Imath::half value;
    std::memcpy(static_cast<void*>(&value), &(*read_.wire.planes[0])[2 * index], 2);
    return value;
  }

  files::LoadedFrame read_;
};

const V2f kD65(0.3127F, 0.3290F);

TEST_F(ExrPrimariesTest, areThoseOfTheChromaticities) {
  write({{0.64F, 0.33F}, {0.30F, 0.60F}, {0.15F, 0.06F}, kD65});
  EXPECT_EQ(primaries(), v1::COLOR_PRIMARIES_BT709);
  write({{0.68F, 0.32F}, {0.265F, 0.69F}, {0.15F, 0.06F}, kD65});
  EXPECT_EQ(primaries(), v1::COLOR_PRIMARIES_DISPLAY_P3);
  write({{0.708F, 0.292F}, {0.17F, 0.797F}, {0.131F, 0.046F}, kD65});
  EXPECT_EQ(primaries(), v1::COLOR_PRIMARIES_BT2020);
  EXPECT_EQ(channel(1), 0.5F) << "as stored";
  EXPECT_EQ(primaries({.primaries = v1::COLOR_PRIMARIES_DISPLAY_P3}),
            v1::COLOR_PRIMARIES_DISPLAY_P3);
}

// ACEScg to BT.2020 by the Bradford matrices that the ACES colour transforms publish:
//   1.0258 -0.0201 -0.0058; -0.0022 1.0046 -0.0024; -0.0050 -0.0253 1.0303
TEST_F(ExrPrimariesTest, areConvertedToBt2020WhenUnknown) {
  write({{0.713F, 0.293F}, {0.165F, 0.830F}, {0.128F, 0.044F}, {0.32168F, 0.33767F}});
  EXPECT_EQ(primaries(), v1::COLOR_PRIMARIES_BT2020);
  EXPECT_NEAR(channel(0), 1.0258 - 0.5 * 0.0201 - 0.25 * 0.0058, 2e-3);
  EXPECT_NEAR(channel(1), -0.0022 + 0.5 * 1.0046 - 0.25 * 0.0024, 2e-3);
  EXPECT_NEAR(channel(2), -0.0050 - 0.5 * 0.0253 + 0.25 * 1.0303, 2e-3);
}

TEST_F(ExrPrimariesTest, areRefusedWhenTheySpanNoColours) {
  const V2f nowhere(0, 0);
  write({nowhere, nowhere, nowhere, nowhere});
  EXPECT_THAT(refusalOf({}, {.color = path_}), HasSubstr("chromaticities that span no colours"));
  const V2f nan(std::numeric_limits<float>::quiet_NaN(), 0.3F);
  write({nan, {0.3F, 0.6F}, {0.15F, 0.06F}, kD65});
  EXPECT_THAT(refusalOf({}, {.color = path_}), HasSubstr("chromaticities that span no colours"));
  EXPECT_EQ(refusalOf({.primaries = v1::COLOR_PRIMARIES_BT709}, {.color = path_}), "OK");
}

}  // namespace
}  // namespace viewloom::test::exr_camera_test
