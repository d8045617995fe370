// SPDX-License-Identifier: Apache-2.0
// EXR files with the channels, headers and units of Blender and of Unreal.
#include <OpenEXR/ImfStringAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "unit/client/test_files.h"
#include "unit/inputs/written_files.h"

namespace viewloom::test::renderer_inputs_test {
namespace {

using files::TestFolder;
using inputs::InputKind;
using ::testing::HasSubstr;

constexpr int kWidth = 16, kHeight = 8;

WrittenChannel constant(const std::string& name, float value, Imf::PixelType type = Imf::HALF) {
  return {name, type, [value](int, int) { return value; }};
}

// Channels as Blender writes a layer with the passes Combined and Z. Depth grows to the right,
// and the last column hits nothing.
std::vector<WrittenChannel> blenderChannels(const std::string& layer) {
  return {constant(layer + ".Combined.R", 0.5F),
          constant(layer + ".Combined.G", 0.25F),
          constant(layer + ".Combined.B", 0.125F),
          constant(layer + ".Combined.A", 1),
          {layer + ".Depth.Z", Imf::FLOAT, [](int x, int) {
             return x == kWidth - 1 ? 1e10F : 2.0F + 0.5F * static_cast<float>(x);
           }}};
}

TEST(BlenderInput, isRecognisedByItsChannelsAndReadInSceneUnits) {
  const TestFolder folder;
  const auto path = folder.path() / "render.exr";
  writeExr(path, kWidth, kHeight, blenderChannels("ViewLayer"));
  const auto read = readInput({}, {.color = path});
  EXPECT_EQ(read.how.kind, InputKind::kBlender);
  EXPECT_NEAR(depthAt(read, 0, 0), 2, 1e-6);
  EXPECT_NEAR(depthAt(read, 4, 7), 4, 1e-6);
  EXPECT_TRUE(std::isinf(depthAt(read, kWidth - 1, 3))) << "the background of 1e10";
  const v1::Plane& color = read.frame.wire.header.sources(0).layers(0).planes(0);
  EXPECT_EQ(color.transfer(), v1::COLOR_TRANSFER_LINEAR);
  EXPECT_EQ(color.alpha(), v1::ALPHA_MODE_PREMULTIPLIED);
  // Without any word of a camera: 40 degrees vertically around the middle.
  const v1::Intrinsics& camera = read.frame.wire.header.sources(0).camera().intrinsics();
  EXPECT_NEAR(camera.focal_y_px(), 4 / std::tan(20 * M_PI / 180), 1e-9);
  EXPECT_EQ(camera.principal_x_px(), 8);
}

TEST(BlenderInput, takesTheLayerThatHasDepthAndTheViewThatIsAsked) {
  const TestFolder folder;
  const auto path = folder.path() / "views.exr";
  writeExr(
      path, kWidth, kHeight,
      {constant("Composite.Combined.R", 1), constant("Composite.Combined.G", 1),
       constant("Composite.Combined.B", 1), constant("View Layer.Combined.left.R", 0.5F),
       constant("View Layer.Combined.left.G", 0.5F), constant("View Layer.Combined.left.B", 0.5F),
       constant("View Layer.Depth.left.Z", 7, Imf::FLOAT)});
  const auto read = readInput({}, {.color = path, .view = "left"});
  EXPECT_EQ(read.how.kind, InputKind::kBlender);
  EXPECT_NEAR(depthAt(read, 3, 3), 7, 1e-6);
}

TEST(BlenderInput, readsDistancesFromTheEyeWhenAsked) {
  const TestFolder folder;
  const auto path = folder.path() / "old.exr";
  writeExr(
      path, kWidth, kHeight,
      {constant("RenderLayer.Combined.R", 1), constant("RenderLayer.Combined.G", 1),
       constant("RenderLayer.Combined.B", 1), constant("RenderLayer.Depth.Z", 10, Imf::FLOAT)});
  // Focal length 8 px: the ray of px (0, 3) goes 7.5 px aside and 0.5 px up.
  const auto read =
      readInput({.depth_meaning = v1::DEPTH_MEANING_RAY_DISTANCE, .focal_px = 8}, {.color = path});
  EXPECT_NEAR(depthAt(read, 0, 3), 10 / std::sqrt(1 + (7.5 * 7.5 + 0.5 * 0.5) / 64), 1e-5);
}

// Writes a picture with a WorldDepth pass as the Movie Render Queue does.
void writeUnreal(const std::filesystem::path& path, const std::string& fov) {
  writeExr(path, kWidth, kHeight,
           {constant("FinalImage.R", 0.5F), constant("FinalImage.G", 0.5F),
            constant("FinalImage.B", 0.5F), constant("FinalImage.A", 1),
            constant("FinalImageMovieRenderQueue_WorldDepth.R", 350, Imf::FLOAT),
            constant("FinalImageMovieRenderQueue_WorldDepth.G", 0, Imf::FLOAT),
            constant("FinalImageMovieRenderQueue_WorldDepth.B", 0, Imf::FLOAT)},
           [&](Imf::Header& header) {
             const auto add = [&header](const char* name, const std::string& text) {
               header.insert(name, Imf::StringAttribute(text));
             };
             add("unreal/camera/curPos/x", "100.0");
             add("unreal/camera/curPos/y", "200.0");
             add("unreal/camera/curPos/z", "300.0");
             add("unreal/camera/curRot/pitch", "0.0");
             add("unreal/camera/curRot/yaw", "90.0");
             add("unreal/camera/curRot/roll", "0.0");
             add("unreal/camera/FinalImage/fov", fov);
           });
}

TEST(UnrealInput, readsCentimetresAndTheCameraOfTheHeader) {
  const TestFolder folder;
  const auto path = folder.path() / "shot.0001.exr";
  writeUnreal(path, "90.0");
  const auto read = readInput({}, {.color = path});
  EXPECT_EQ(read.how.kind, InputKind::kUnreal);
  EXPECT_NEAR(depthAt(read, 5, 5), 3.5, 1e-6);
  const v1::Camera& camera = read.frame.wire.header.sources(0).camera();
  // 90 degrees across 16 px, square px.
  EXPECT_NEAR(camera.intrinsics().focal_x_px(), 8, 1e-9);
  EXPECT_NEAR(camera.intrinsics().focal_y_px(), 8, 1e-9);
  // 1 m forward (-z), 2 m to the right (+x), 3 m up (+y).
  EXPECT_NEAR(camera.pose().position().x(), 2, 1e-12);
  EXPECT_NEAR(camera.pose().position().y(), 3, 1e-12);
  EXPECT_NEAR(camera.pose().position().z(), -1, 1e-12);
  // Yaw of 90 degrees looks to the right: a turn by -90 degrees about +y.
  EXPECT_NEAR(std::abs(camera.pose().orientation().w()), std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(camera.pose().orientation().y() * camera.pose().orientation().w(), -0.5, 1e-9);
  EXPECT_NEAR(camera.pose().orientation().x(), 0, 1e-9);
}

TEST(UnrealInput, refusesCamerasThatCannotBe) {
  const TestFolder folder;
  const auto path = folder.path() / "shot.exr";
  for (const char* fov : {"nan", "1e999", "wide", ""}) {
    writeUnreal(path, fov);
    EXPECT_THAT(refusalOf({}, {.color = path}),
                HasSubstr("unreal/camera/FinalImage/fov is \"" + std::string(fov) +
                          "\"; accepted is a number"));
  }
  writeUnreal(path, "180");
  EXPECT_THAT(refusalOf({}, {.color = path}), HasSubstr("field of view is 180 degrees; accepted"));
}

TEST(RendererInputs, areRefusedWhereTheirChannelsAreMissing) {
  const TestFolder folder;
  const auto path = folder.path() / "flat.exr";
  writeExr(path, kWidth, kHeight,
           {constant("R", 1), constant("G", 1), constant("B", 1), constant("mist.V", 1)});
  EXPECT_THAT(refusalOf({.kind = InputKind::kUnreal}, {.color = path}),
              HasSubstr("has no channel that ends in WorldDepth.R"));
  EXPECT_THAT(refusalOf({.kind = InputKind::kBlender}, {.color = path}),
              HasSubstr("name its channel with --depth-channel"));
}

TEST(RendererInputs, refuseFilesCutShortAtEveryLength) {
  const TestFolder folder;
  const auto path = folder.path() / "shot.exr";
  writeUnreal(path, "90");
  const size_t size = files::bytesOf(path).size();
  for (size_t count = 0; count < size; count += 11) {
    const auto cut = folder.truncated(path, count);
    ASSERT_NE(refusalOf({}, {.color = cut}), "OK") << count << " of " << size;
  }
}

// Every byte of the header turned into what numbers and lengths are worst at.
TEST(RendererInputs, surviveWhateverTheHeaderSays) {
  const TestFolder folder;
  const auto path = folder.path() / "shot.exr";
  writeUnreal(path, "90");
  const std::string good = files::bytesOf(path);
  const size_t header_size = good.find("screenWindowWidth") + 40;
  size_t refused_count = 0;
  for (size_t at = 0; at < header_size; ++at) {
    for (const char byte : {'\x00', '\x7F', '\xFF'}) {
      std::string bytes = good;
      bytes[at] = byte;
      const std::string said =
          refusalOf({}, {.color = folder.write("hostile.exr", bytes).string()});
      ASSERT_FALSE(said.empty()) << at;
      if (said != "OK") ++refused_count;
    }
  }
  EXPECT_GT(refused_count, header_size) << "a byte that is read counts";
}

}  // namespace
}  // namespace viewloom::test::renderer_inputs_test
