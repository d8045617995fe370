// SPDX-License-Identifier: Apache-2.0
#include "files/frame_manifest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "files/png_image.h"
#include "unit/client/test_files.h"
#include "unit/client/written_pictures.h"

namespace viewloom::files::frame_manifest_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// A colour PNG and a depth PNG of 2x1 px, and a manifest around them.
class FrameManifestTest : public ::testing::Test {
 protected:
  FrameManifestTest() {
    writePicture("color.png", 2, 3);
    writePicture("depth.png", 2, 1);
    writePicture("wide.png", 3, 1);
  }

  void writePicture(const std::string& name, uint32_t width_px, uint32_t channels) const {
    const std::vector<uint8_t> samples(size_t{width_px} * channels, 8);
    folder_.write(name, *encodePng(samples, width_px, 1, channels));
  }

  absl::StatusOr<WireFrame> load(const std::string& json) const {
    const auto manifest = readFrameManifest(folder_.write("frame.json", json));
    if (!manifest.ok()) return manifest.status();
    absl::StatusOr<LoadedFrame> frame = loadFrame(*manifest, folder_.path());
    if (!frame.ok()) return frame.status();
    return std::move(frame->wire);
  }

  std::string refusal(const std::string& json) const {
    const auto frame = load(json);
    return frame.ok() ? "OK" : std::string(frame.status().message());
  }

  TestFolder folder_;
};

std::string layer(const std::string& color, const std::string& depth) {
  return R"({"color": {"file": ")" + color + R"("}, "depth": {"file": ")" + depth +
         R"(", "depth": {"meaning": "DEPTH_MEANING_DISPARITY", "scale": 0.01}}})";
}

// With more planes in JSON.
std::string layerWith(const std::string& more) {
  std::string json = layer("color.png", "depth.png");
  json.pop_back();
  return json + ", " + more + "}";
}

std::string source(const std::string& layers) {
  return R"({"number": "7", "sources": [{"camera": {"intrinsics": {"focalXPx": 2, "focalYPx": 2,
    "principalXPx": 1, "principalYPx": 0.5}}, "layers": [)" +
         layers + "]}]}";
}

TEST_F(FrameManifestTest, makesAFrameWithEveryPlaneDescribed) {
  const auto frame = load(source(layer("color.png", "depth.png")));
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_EQ(frame->header.number(), 7U);
  ASSERT_EQ(frame->planes.size(), 2U);
  const auto& planes = frame->header.sources(0).layers(0).planes();
  EXPECT_EQ(planes[0].kind(), v1::PLANE_KIND_COLOR);
  EXPECT_EQ(planes[0].encoding(), v1::PLANE_ENCODING_RGB8);
  EXPECT_EQ(planes[0].transfer(), v1::COLOR_TRANSFER_SRGB);
  EXPECT_EQ(planes[0].bytes_count(), 6U);
  EXPECT_EQ(planes[1].kind(), v1::PLANE_KIND_DEPTH);
  EXPECT_EQ(planes[1].encoding(), v1::PLANE_ENCODING_DEPTH_U16);
  EXPECT_EQ(planes[1].depth().scale(), 0.01);
  EXPECT_EQ(planes[1].bytes_count(), frame->planes[1]->size());
}

TEST_F(FrameManifestTest, takesSourcesOneAfterTheOther) {
  const std::string one =
      R"({"camera": {"fov": {}}, "layers": [)" + layer("color.png", "depth.png") + "]}";
  const auto frame = load(R"({"sources": [)" + one + "," + one + "," + one + "]}");
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_EQ(frame->header.sources_size(), 3);
  EXPECT_EQ(frame->planes.size(), 6U);
}

TEST_F(FrameManifestTest, marksACubeMap) {
  const auto frame = load(R"({"sources": [{"cubeMap": true, "layers": [)" +
                          layer("color.png", "depth.png") + "]}]}");
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_TRUE(frame->header.sources(0).cube_map());
  EXPECT_FALSE(frame->header.sources(0).has_camera());
}

TEST_F(FrameManifestTest, numbersAFrameWithoutANumberOne) {
  std::string json = source(layer("color.png", "depth.png"));
  json.replace(json.find(R"("number": "7", )"), 15, "");
  const auto frame = load(json);
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_EQ(frame->header.number(), 1U);
}

TEST_F(FrameManifestTest, refusesUnknownKeysAndBrokenJson) {
  EXPECT_THAT(refusal(R"({"sorces": []})"), HasSubstr("does not describe a frame in JSON"));
  EXPECT_THAT(refusal("{"), HasSubstr("does not describe a frame in JSON"));
}

TEST_F(FrameManifestTest, namesTheFieldAndTheFileAtFault) {
  EXPECT_THAT(refusal("{}"), HasSubstr("sources: has 0; accepted is 1..8"));
  EXPECT_THAT(refusal(source("")), HasSubstr("sources[0].layers: has 0; accepted is 1..4"));
  EXPECT_THAT(refusal(source(layer("none.png", "depth.png"))),
              HasSubstr("sources[0].layers[0].color: "));
  EXPECT_THAT(refusal(source(layer("none.png", "depth.png"))), HasSubstr("none.png: no such file"));
  folder_.write("color.gif", "GIF89a");
  EXPECT_THAT(refusal(source(layer("color.gif", "depth.png"))),
              AllOf(HasSubstr("sources[0].layers[0].color: "), HasSubstr("color.gif: is a GIF")));
  EXPECT_THAT(refusal(source(layer("color.png", "color.gif"))),
              AllOf(HasSubstr("sources[0].layers[0].depth: "), HasSubstr("color.gif: is a GIF")));
}

TEST_F(FrameManifestTest, refusesDepthPlanesOfDifferentSizes) {
  const std::string layers = layer("color.png", "depth.png") + "," + layer("color.png", "wide.png");
  EXPECT_THAT(refusal(source(layers)),
              HasSubstr("sources[0].layers[1].depth: is 3x1 px; accepted is the size of layer 0"));
}

TEST_F(FrameManifestTest, takesPlanesThatSayHowALayerMirrors) {
  const auto frame = load(source(layerWith(
      R"("normal": {"file": "color.png"}, "normalSpace": "NORMAL_SPACE_WORLD",
         "roughness": {"file": "depth.png"}, "specular": {"file": "color.png"},
         "colorHasReflections": true)")));
  ASSERT_TRUE(frame.ok()) << frame.status();
  const v1::Layer& taken = frame->header.sources(0).layers(0);
  EXPECT_TRUE(taken.color_has_reflections());
  ASSERT_EQ(taken.planes_size(), 5);
  EXPECT_EQ(taken.planes(2).kind(), v1::PLANE_KIND_NORMAL);
  EXPECT_EQ(taken.planes(2).encoding(), v1::PLANE_ENCODING_XYZ8);
  EXPECT_EQ(taken.planes(2).normal_space(), v1::NORMAL_SPACE_WORLD);
  EXPECT_EQ(*frame->planes[2], std::vector<uint8_t>(6, 8));
  EXPECT_EQ(taken.planes(3).kind(), v1::PLANE_KIND_ROUGHNESS);
  EXPECT_EQ(taken.planes(3).encoding(), v1::PLANE_ENCODING_R8);
  EXPECT_EQ(*frame->planes[3], std::vector<uint8_t>(2, 8));
  EXPECT_EQ(taken.planes(4).kind(), v1::PLANE_KIND_SPECULAR);
  EXPECT_EQ(taken.planes(4).encoding(), v1::PLANE_ENCODING_RGB8);
  EXPECT_EQ(taken.planes(4).bytes_count(), 6U);
}

TEST_F(FrameManifestTest, takesVectorsAndSharesOfFloats) {
  // A px that faces, or moves by, (-1, 0.5, 2), and mirrors more than there is.
  const float samples[] = {-1, 0.5F, 2};
  std::string pfm = "PF\n1 1\n-1\n";
  pfm.append(reinterpret_cast<const char*>(samples), sizeof samples);
  folder_.write("floats.pfm", pfm);
  const auto frame = load(source(layerWith(
      R"("normal": {"file": "floats.pfm"}, "specular": {"file": "floats.pfm"},
         "motion": {"file": "floats.pfm"})")));
  ASSERT_TRUE(frame.ok()) << frame.status();
  const v1::Layer& taken = frame->header.sources(0).layers(0);
  EXPECT_EQ(taken.planes(2).encoding(), v1::PLANE_ENCODING_XYZ16F);
  EXPECT_EQ(*frame->planes[2], (std::vector<uint8_t>{0x00, 0xbc, 0x00, 0x38, 0x00, 0x40}));
  EXPECT_EQ(*frame->planes[3], (std::vector<uint8_t>{0, 128, 255}));
  EXPECT_EQ(taken.planes(4).kind(), v1::PLANE_KIND_MOTION);
  EXPECT_EQ(taken.planes(4).encoding(), v1::PLANE_ENCODING_XYZ16F);
  EXPECT_EQ(*frame->planes[4], *frame->planes[2]);
}

TEST_F(FrameManifestTest, namesTheSurfacePlaneAtFault) {
  const std::string at = "sources[0].layers[0].";
  EXPECT_THAT(refusal(source(layerWith(R"("motion": {"file": "color.png"})"))),
              HasSubstr(at + "motion.file: is color.png, of whole numbers; accepted are floats"));
  EXPECT_THAT(refusal(source(layerWith(R"("specular": {"file": "none.png"})"))),
              HasSubstr(at + "specular: "));
  folder_.write("normal.jpg", writtenJpeg(2, 1, std::vector<uint8_t>(6, 128)));
  EXPECT_THAT(refusal(source(layerWith(R"("normal": {"file": "normal.jpg"})"))),
              HasSubstr(at + "normal.file: is normal.jpg, a JPEG, which changes numbers"));
  EXPECT_THAT(refusal(source(layerWith(
                  R"("roughness": {"file": "depth.png", "transfer": "COLOR_TRANSFER_SRGB"})"))),
              HasSubstr(at + "roughness.transfer: given for depth.png"));
  EXPECT_THAT(refusal(source(layerWith(R"("normalSpace": "NORMAL_SPACE_WORLD")"))),
              HasSubstr(at + "normal_space: is given without normal"));
}

TEST_F(FrameManifestTest, refusesDepthWithoutAMeaning) {
  const std::string json =
      source(R"({"color": {"file": "color.png"}, "depth": {"file": "depth.png"}})");
  EXPECT_THAT(refusal(json), HasSubstr("sources[0].layers[0].depth.depth.meaning: is missing"));
}

TEST_F(FrameManifestTest, takesADeepFileOrLayersButNotBoth) {
  const std::string deep = R"("deep": {"file": "none.exr",
    "depth": {"meaning": "DEPTH_MEANING_PLANAR"}})";
  EXPECT_THAT(refusal(R"({"sources": [{)" + deep + "}]}"), HasSubstr("sources[0].deep: "));
  EXPECT_THAT(refusal(R"({"sources": [{)" + deep + "}]}"), HasSubstr("none.exr: no such file"));
  EXPECT_THAT(refusal(R"({"sources": [{)" + deep + R"(, "layers": [)" +
                      layer("color.png", "depth.png") + "]}]}"),
              HasSubstr("sources[0].layers: are given beside deep"));
}

TEST_F(FrameManifestTest, refusesChannelsOfFilesThatHaveNoNamesForThem) {
  std::string json = source(layer("color.png", "depth.png"));
  json.replace(json.find(R"("color.png")"), 11, R"("color.png", "channels": ["R"])");
  EXPECT_THAT(refusal(json), HasSubstr("color.channels: given for color.png"));
}

}  // namespace
}  // namespace viewloom::files::frame_manifest_test
