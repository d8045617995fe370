// SPDX-License-Identifier: Apache-2.0
// EXR files of other tools: names of channels, facts of headers, and what depth they write.
#include <Imath/half.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "unit/client/test_files.h"
#include "unit/inputs/written_files.h"

namespace viewloom::test::exr_inputs_test {
namespace {

using files::TestFolder;
using inputs::InputKind;
using ::testing::Contains;
using ::testing::HasSubstr;
constexpr int kWidth = 16, kHeight = 8;

WrittenChannel constant(const std::string& name, float value, Imf::PixelType type = Imf::HALF) {
  return {name, type, [value](int, int) { return value; }};
}

// Depth of the tests: 2 m on the left, 4 m on the right.
float depthOf(int x, int) {
  return x < kWidth / 2 ? 2.0F : 4.0F;
}

std::array<float, 4> colorAt(const inputs::ReadInput& read, uint32_t x, uint32_t y) {
  const v1::Plane& plane = read.frame.wire.header.sources(0).layers(0).planes(0);
  std::array<float, 4> rgba{};
  for (size_t i = 0; i < 4; ++i) {
    uint16_t bits = 0;
    std::memcpy(&bits, &(*read.frame.wire.planes[0])[8 * (y * plane.size().width() + x) + 2 * i],
                2);
    rgba[i] = Imath::half(Imath::half::FromBits, bits);
  }
  return rgba;
}

class ExrInputs : public ::testing::Test {
 protected:
  std::string write(
      const std::vector<WrittenChannel>& channels,
      const std::function<void(Imf::Header&)>& edit = [](Imf::Header&) {}) {
    const std::string path = folder_.path() / ("file" + std::to_string(count_++) + ".exr");
    writeExr(path, kWidth, kHeight, channels, edit);
    return path;
  }
  std::string picture() {
    const std::string path = folder_.path() / "picture.png";
    writePng(path, kWidth, kHeight, 3, 8, std::vector<uint16_t>(3 * kWidth * kHeight, 128));
    return path;
  }

  TestFolder folder_;
  int count_ = 0;
};

TEST_F(ExrInputs, findColourAndDepthByTheNamesOfOtherTools) {
  const std::vector<std::array<const char*, 4>> tools{
      {"r", "g", "b", "Z"},
      {"red", "green", "blue", "depth.z"},
      {"R", "G", "B", "Z.Z"},
      {"R", "G", "B", "Pz"},
      {"C.r", "C.g", "C.b", "Pz.z"},
      {"rgba.R", "rgba.G", "rgba.B", "zDepth.R"},
      {"Beauty.R", "Beauty.G", "Beauty.B", "VRayZDepth.R"},
      {"Image.R", "Image.G", "Image.B", "Depth.V"}};
  for (const auto& [red, green, blue, depth] : tools) {
    const std::string path = write({constant(red, 0.25F),
                                    constant(green, 0.5F),
                                    constant(blue, 0.75F),
                                    {depth, Imf::FLOAT, depthOf},
                                    constant("N.X", 9),
                                    constant("N.Y", 9),
                                    constant("N.Z", 9),
                                    constant("albedo.R", 9),
                                    constant("albedo.G", 9),
                                    constant("albedo.B", 9)});
    const auto read = readInput({}, {.color = path});
    EXPECT_NEAR(depthAt(read, 2, 2), 2, 1e-5) << depth;
    EXPECT_NEAR(depthAt(read, 12, 2), 4, 1e-5) << depth;
    EXPECT_THAT(colorAt(read, 3, 3), ::testing::ElementsAre(0.25F, 0.5F, 0.75F, 1)) << red;
    EXPECT_THAT(read.how.notes, Contains(HasSubstr(std::string("depth in ") + depth)));
  }
}

TEST_F(ExrInputs, readDepthOfAFileOfItsOwnWhateverItsChannelIsCalled) {
  const auto check = [this](const std::string& depth, const char* note) {
    const auto read = readInput({}, {.color = picture(), .depth = depth});
    EXPECT_NEAR(depthAt(read, 2, 2), 2, 1e-3) << note;
    EXPECT_NEAR(depthAt(read, 12, 2), 4, 1e-3) << note;
    EXPECT_THAT(read.how.notes, Contains(HasSubstr(note)));
  };
  check(write({{"V", Imf::FLOAT, depthOf}}), "depth in V");
  check(write({{"anything", Imf::HALF, depthOf}}), "depth in anything");
  check(write({{"R", Imf::FLOAT, depthOf},
               {"G", Imf::FLOAT, depthOf},
               {"B", Imf::FLOAT, depthOf},
               constant("A", 1)}),
        "depth in R, which the other channels repeat");
  const auto centimetres = [](int x, int y) { return 100 * depthOf(x, y); };
  check(write({{"FinalImageMovieRenderQueue_WorldDepth.R", Imf::HALF, centimetres},
               {"FinalImageMovieRenderQueue_WorldDepth.G", Imf::HALF, centimetres},
               {"FinalImageMovieRenderQueue_WorldDepth.B", Imf::HALF, centimetres}}),
        "in cm");
  const std::string apart = write({constant("R", 1), constant("G", 2), constant("B", 1)});
  EXPECT_THAT(refusalOf({}, {.color = picture(), .depth = apart}),
              HasSubstr("R and G differ; name its channel with --depth-channel"));
}

TEST_F(ExrInputs, takeTheChannelsThatAreNamedAndListThemOtherwise) {
  const std::string path = write({constant("first.R", 0.25F),
                                  constant("first.G", 0.25F),
                                  constant("first.B", 0.25F),
                                  constant("second.R", 0.5F),
                                  constant("second.G", 0.5F),
                                  constant("second.B", 0.5F),
                                  {"far.q", Imf::FLOAT, depthOf}});
  EXPECT_THAT(refusalOf({}, {.color = path}),
              AllOf(HasSubstr("--color-channels"), HasSubstr("second.R")));
  inputs::InputSettings settings{.color_channels = "Second"};
  EXPECT_THAT(refusalOf(settings, {.color = path}), HasSubstr("--depth-channel"));
  settings.depth_channel = "far.Q";
  EXPECT_EQ(colorAt(readInput(settings, {.color = path}), 1, 1)[0], 0.5F);
  settings.color_channels = "first.R, second.G,first.B";
  const auto read = readInput(settings, {.color = path});
  EXPECT_EQ(colorAt(read, 1, 1)[1], 0.5F);
  EXPECT_NEAR(depthAt(read, 12, 2), 4, 1e-5);
  settings.color_channels = "third";
  EXPECT_THAT(refusalOf(settings, {.color = path}), HasSubstr("accepted are a layer with colour "
                                                              "(first, second)"));
}

TEST_F(ExrInputs, showAViewOfStereoFilesWithoutBeingAsked) {
  std::vector<WrittenChannel> channels;
  for (const std::string view : {"left", "right"}) {
    for (const char* name : {"R", "G", "B"}) {
      channels.push_back(constant("ViewLayer.Combined." + view + "." + name, 0.5F));
    }
    channels.push_back(
        constant("ViewLayer.Depth." + view + ".Z", view == "left" ? 2 : 3, Imf::FLOAT));
  }
  const std::string path = write(channels, [](Imf::Header& header) {
    Imf::addMultiView(header, {"left", "right"});
  });
  EXPECT_NEAR(depthAt(readInput({}, {.color = path}), 1, 1), 2, 1e-6);
  EXPECT_NEAR(depthAt(readInput({}, {.color = path, .view = "right"}), 1, 1), 3, 1e-6);
  EXPECT_THAT(refusalOf({}, {.color = path, .view = "rigth"}),
              HasSubstr("has no view rigth; accepted are left, right"));
}

// Colours that OpenEXR itself splits into luminance and half as much chroma.
TEST_F(ExrInputs, readLuminanceAndChromaAsColour) {
  const std::string path = folder_.path() / "yc.exr";
  {
    Imf::RgbaOutputFile file(path.c_str(), Imf::Header(kWidth, kHeight), Imf::WRITE_YC);
    std::vector<Imf::Rgba> pixels(kWidth * kHeight, Imf::Rgba(0.75F, 0.25F, 0.5F));
    file.setFrameBuffer(pixels.data(), 1, kWidth);
    file.writePixels(kHeight);
  }
  const std::string depth = write({{"Z", Imf::FLOAT, depthOf}});
  const auto read = readInput({}, {.color = path, .depth = depth});
  const auto rgba = colorAt(read, 7, 5);
  EXPECT_NEAR(rgba[0], 0.75, 0.005);
  EXPECT_NEAR(rgba[1], 0.25, 0.005);
  EXPECT_NEAR(rgba[2], 0.5, 0.005);
}

TEST_F(ExrInputs, useOverscanAndKeepTheCameraOfTheDisplayWindow) {
  const auto overscan = [](Imf::Header& header) {
    header.displayWindow() = Imath::Box2i(Imath::V2i(3, 1), Imath::V2i(12, 6));  // 10 x 6 px
  };
  const std::string path = write(
      {constant("R", 1), constant("G", 1), constant("B", 1), {"Z", Imf::FLOAT, depthOf}}, overscan);
  const auto read = readInput({.fov_y_deg = 90}, {.color = path});
  const v1::Source& source = read.frame.wire.header.sources(0);
  EXPECT_EQ(source.layers(0).planes(1).size().width(), 16U);
  // 90 degrees over 6 px, around the middle of the display window.
  EXPECT_NEAR(source.camera().intrinsics().focal_y_px(), 3, 1e-9);
  EXPECT_NEAR(source.camera().intrinsics().principal_x_px(), 8, 1e-9);
  EXPECT_NEAR(depthAt(read, 7, 0), 2, 1e-6);
  EXPECT_THAT(read.how.notes, Contains(HasSubstr("overscan is used")));
}

TEST_F(ExrInputs, leavePxWithoutDataWithoutSurface) {
  const auto crop = [](Imf::Header& header) {
    header.displayWindow() = Imath::Box2i(Imath::V2i(0, 0), Imath::V2i(31, 7));
  };
  const std::string path = write(
      {constant("R", 1), constant("G", 1), constant("B", 1), {"Z", Imf::FLOAT, depthOf}}, crop);
  for (const auto meaning : {v1::DEPTH_MEANING_PLANAR, v1::DEPTH_MEANING_DISPARITY}) {
    const auto read = readInput({.depth_meaning = meaning}, {.color = path});
    EXPECT_TRUE(std::isfinite(depthAt(read, 15, 3)));
    EXPECT_TRUE(std::isnan(depthAt(read, 16, 3))) << "not infinitely far either";
    EXPECT_EQ(colorAt(read, 20, 3)[3], 0);
  }
}

TEST_F(ExrInputs, readTheDepthThatRenderersWrite) {
  const auto rgb = [](const std::function<float(int, int)>& depth) {
    return std::vector<WrittenChannel>{
        constant("R", 1), constant("G", 1), constant("B", 1), {"depth.Z", Imf::FLOAT, depth}};
  };
  const std::string inverse =
      write(rgb([](int x, int y) { return y == 0 ? 0 : 1 / depthOf(x, y); }));
  const auto nuke = readInput({.kind = InputKind::kNuke}, {.color = inverse});
  EXPECT_NEAR(depthAt(nuke, 12, 3), 4, 1e-5);
  EXPECT_TRUE(std::isinf(depthAt(nuke, 12, 0)));
  EXPECT_NEAR(
      depthAt(readInput({.depth_meaning = v1::DEPTH_MEANING_DISPARITY}, {.color = inverse}), 12, 3),
      4, 1e-5);
  for (const float nothing :
       {1e10F, 1e30F, std::numeric_limits<float>::max(), std::numeric_limits<float>::infinity()}) {
    for (const float sign : {1.0F, -1.0F}) {
      const std::string path =
          write(rgb([&](int x, int y) { return sign * (y == 0 ? nothing : depthOf(x, y)); }));
      for (const auto kind :
           {InputKind::kArnold, InputKind::kVray, InputKind::kRedshift, InputKind::kHoudini}) {
        const auto read = readInput({.kind = kind}, {.color = path});
        EXPECT_NEAR(depthAt(read, 12, 3), 4, 1e-5) << nothing * sign;
        EXPECT_TRUE(std::isinf(depthAt(read, 12, 0))) << nothing * sign;
      }
    }
  }
  const std::string negative = write(rgb([](int x, int y) { return -depthOf(x, y); }));
  EXPECT_NEAR(depthAt(readInput({.depth_scale = -1}, {.color = negative}), 12, 3), 4, 1e-5);
  const std::string share = write(rgb([](int x, int y) { return (depthOf(x, y) - 1) / 4; }));
  EXPECT_NEAR(
      depthAt(readInput({.kind = InputKind::kVray, .near_m = 1, .far_m = 5}, {.color = share}), 12,
              3),
      4, 1e-5);
}

TEST_F(ExrInputs, knowRenderersThatNameThemselves) {
  const std::vector<WrittenChannel> channels{
      constant("R", 1), constant("G", 1), constant("B", 1), {"Z", Imf::FLOAT, depthOf}};
  const auto kindOf = [&](const char* key, const char* value) {
    const std::string path = write(
        channels, [&](Imf::Header& header) { header.insert(key, Imf::StringAttribute(value)); });
    return readInput({}, {.color = path}).how.kind;
  };
  EXPECT_EQ(kindOf("arnold/version", "7.1"), InputKind::kArnold);
  EXPECT_EQ(kindOf("Software", "Redshift 3.5"), InputKind::kRedshift);
  EXPECT_EQ(kindOf("vrayInfo/vrayversion", "5"), InputKind::kVray);
  EXPECT_EQ(kindOf("renderer", "karma"), InputKind::kHoudini);
  EXPECT_EQ(kindOf("comments", "painted after an arnold render"), InputKind::kPlain);
}

TEST_F(ExrInputs, sayThatPositionsAreNoPicture) {
  const std::string path = write({constant("X", 1), constant("Y", 1), constant("Z", -4)});
  EXPECT_THAT(refusalOf({}, {.color = path}), HasSubstr("has positions (X, Y and Z of a point)"));
}

// A wall 2 m ahead, seen in all directions: its distance grows away from the axis, its Z does not.
TEST_F(ExrInputs, turnPanoramasIntoCubeMaps) {
  const std::string path = folder_.path() / "panorama.exr";
  constexpr int kAcross = 256, kDown = 128;
  const auto distance = [](int x, int y) {
    const double longitude = ((x + 0.5) / kAcross - 0.5) * 2 * M_PI;
    const double latitude = (0.5 - (y + 0.5) / kDown) * M_PI;
    const double ahead = std::cos(latitude) * std::cos(longitude);
    return ahead > 0.2 ? float(2 / ahead) : 10.0F;
  };
  writeExr(path, kAcross, kDown,
           {{"R", Imf::HALF, [](int x, int) { return x < kAcross / 2 ? 0.0F : 1.0F; }},
            {"G", Imf::HALF, [](int, int y) { return y < kDown / 2 ? 1.0F : 0.0F; }},
            constant("B", 0.5F),
            {"Z", Imf::FLOAT, distance}},
           [](Imf::Header& header) { Imf::addEnvmap(header, Imf::ENVMAP_LATLONG); });
  const auto read = readInput({}, {.color = path});
  const v1::Source& source = read.frame.wire.header.sources(0);
  ASSERT_TRUE(source.cube_map());
  EXPECT_FALSE(source.camera().has_intrinsics());
  const uint32_t side = source.layers(0).planes(1).size().width();
  EXPECT_EQ(side, 81U);
  EXPECT_EQ(source.layers(0).planes(0).size().height(), 6 * side);
  // The face ahead is the last: the wall, red on the right, green above.
  for (const uint32_t at : {10U, 40U, 70U}) {
    EXPECT_NEAR(depthAt(read, at, 5 * side + at), 2, 0.05);
    EXPECT_EQ(colorAt(read, at < 40 ? 10 : 70, 5 * side + 20)[0], at < 40 ? 0 : 1);
  }
  EXPECT_EQ(colorAt(read, 20, 5 * side + 10)[1], 1);
  // To the right everything is red, 10 m off in the middle of the face.
  EXPECT_NEAR(depthAt(read, 40, 40), 10, 0.05);
  EXPECT_FALSE(readInput({.projection = inputs::Projection::kFlat}, {.color = path})
                   .frame.wire.header.sources(0)
                   .cube_map());
}

}  // namespace
}  // namespace viewloom::test::exr_inputs_test
