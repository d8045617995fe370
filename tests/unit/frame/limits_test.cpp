// SPDX-License-Identifier: Apache-2.0
#include "frame/limits.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace viewloom::limits_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr absl::StatusCode kInvalid = absl::StatusCode::kInvalidArgument;
constexpr absl::StatusCode kExhausted = absl::StatusCode::kResourceExhausted;

PlaneFormat rawPlane(PlaneKind kind, PlaneEncoding encoding, SizePx size_px) {
  PlaneFormat plane{.kind = kind, .encoding = encoding, .size_px = size_px};
  plane.wire_bytes = uncompressedBytes(plane);
  return plane;
}

LayerFormat goodLayer() {
  return {.color = rawPlane(PlaneKind::kColor, PlaneEncoding::kRgba8, {6, 4}),
          .depth = rawPlane(PlaneKind::kDepth, PlaneEncoding::kDepthF32, {3, 2})};
}

FrameFormat goodFrame() {
  SourceFormat source;
  source.camera.intrinsics = {.focal_px = {3, 3}, .principal_px = {1.5, 1}};
  source.layers = {goodLayer(), goodLayer()};
  return {.number = 1, .sources = {source}};
}

struct Case {
  const char* what;
  std::function<void(FrameFormat&)> spoil;
  absl::StatusCode code;
  std::string field;
};

PlaneFormat& color(FrameFormat& frame) {
  return frame.sources[0].layers[1].color;
}
PlaneFormat& depth(FrameFormat& frame) {
  return frame.sources[0].layers[1].depth;
}

void resize(PlaneFormat& plane, SizePx size_px) {
  plane.size_px = size_px;
  plane.wire_bytes = uncompressedBytes(plane);
}

const std::string kLayer = "header.sources[0].layers[1]";
const std::string kColor = kLayer + ".planes[0]";
const std::string kDepth = kLayer + ".planes[1]";

void expectRefusals(const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    FrameFormat frame = goodFrame();
    c.spoil(frame);
    const absl::Status status = validateFrame(frame, {});
    EXPECT_EQ(status.code(), c.code) << c.what << ": " << status;
    EXPECT_EQ(fieldOf(status), c.field) << c.what << ": " << status;
  }
}

TEST(ValidateFrame, acceptsWhatIsWhole) {
  EXPECT_TRUE(validateFrame(goodFrame(), {}).ok());
}

TEST(ValidateFrame, takesSourcesOfSeveralSizes) {
  FrameFormat frame = goodFrame();
  frame.sources.resize(8, frame.sources[0]);
  for (LayerFormat& layer : frame.sources[3].layers) resize(layer.depth, {7, 5});
  EXPECT_TRUE(validateFrame(frame, {}).ok());
}

FrameFormat goodCubeMap(uint32_t side_px) {
  FrameFormat frame = goodFrame();
  frame.sources[0].is_cube_map = true;
  for (LayerFormat& layer : frame.sources[0].layers) {
    resize(layer.color, {side_px, 6 * side_px});
    resize(layer.depth, {side_px, 6 * side_px});
  }
  return frame;
}

TEST(ValidateFrame, limitsTheSideOfAFaceOfACubeMap) {
  EXPECT_TRUE(validateFrame(goodCubeMap(7), {.plane_side_px_max = 7}).ok());
  const absl::Status status = validateFrame(goodCubeMap(7), {.plane_side_px_max = 6});
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted) << status;
  EXPECT_EQ(fieldOf(status), "header.sources[0].layers[0].planes[0].size");
}

TEST(ValidateFrame, countsTheBytesOfAllFacesOfACubeMap) {
  constexpr uint64_t kBytes = uint64_t{2} * 6 * 7 * 7 * (4 + 4);
  EXPECT_TRUE(validateFrame(goodCubeMap(7), {.frame_bytes_max = kBytes}).ok());
  EXPECT_EQ(validateFrame(goodCubeMap(7), {.frame_bytes_max = kBytes - 1}).code(),
            absl::StatusCode::kResourceExhausted);
}

TEST(ValidateFrame, addsUpTheBytesOfAllSources) {
  FrameFormat frame = goodFrame();
  uint64_t one_source_bytes = 0;
  for (const LayerFormat& layer : frame.sources[0].layers) {
    one_source_bytes += layer.color.wire_bytes + layer.depth.wire_bytes;
  }
  frame.sources.push_back(frame.sources[0]);
  EXPECT_TRUE(validateFrame(frame, {.frame_bytes_max = 2 * one_source_bytes}).ok());
  const absl::Status status = validateFrame(frame, {.frame_bytes_max = 2 * one_source_bytes - 1});
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted) << status;
  EXPECT_EQ(fieldOf(status), "header");
}

TEST(ValidateFrame, namesTheFieldOfABadFrame) {
  expectRefusals({
      {"number 0", [](auto& f) { f.number = 0; }, kInvalid, "header.number"},
      {"exposure", [](auto& f) { f.exposure_ev = 33; }, kInvalid, "header.exposure_ev"},
      {"NaN exposure", [](auto& f) { f.exposure_ev = kNan; }, kInvalid, "header.exposure_ev"},
      {"no source", [](auto& f) { f.sources.clear(); }, kInvalid, "header.sources"},
      {"nine sources", [](auto& f) { f.sources.resize(9); }, kInvalid, "header.sources"},
      {"a second source without layers",
       [](auto& f) {
         f.sources.push_back(f.sources[0]);
         f.sources[1].layers.clear();
       },
       kInvalid, "header.sources[1].layers"},
      {"no layer", [](auto& f) { f.sources[0].layers.clear(); }, kInvalid,
       "header.sources[0].layers"},
      {"five layers", [](auto& f) { f.sources[0].layers.resize(5, goodLayer()); }, kInvalid,
       "header.sources[0].layers"},
      {"NaN pose", [](auto& f) { f.sources[0].camera.pose.position_m.y = kNan; }, kInvalid,
       "header.sources[0].camera.pose.position"},
      {"no focal length", [](auto& f) { f.sources[0].camera.intrinsics.focal_px.x = 0; }, kInvalid,
       "header.sources[0].camera.intrinsics.focal_x_px"},
      {"negative tolerance", [](auto& f) { f.sources[0].connection_tolerance = -1; }, kInvalid,
       "header.sources[0].connection_tolerance"},
      {"infinite tolerance", [](auto& f) { f.sources[0].connection_tolerance = kInf; }, kInvalid,
       "header.sources[0].connection_tolerance"},
  });
}

TEST(ValidateFrame, namesTheFieldOfAnImpossibleSizeOrKind) {
  const uint32_t most = std::numeric_limits<uint32_t>::max();
  expectRefusals({
      {"no width",
       [](auto& f) {
         resize(color(f), {0, 4});
       },
       kInvalid, kColor + ".size"},
      {"no height",
       [](auto& f) {
         resize(depth(f), {3, 0});
       },
       kInvalid, kDepth + ".size"},
      {"too wide",
       [](auto& f) {
         resize(color(f), {8193, 1});
       },
       kExhausted, kColor + ".size"},
      {"overflowing",
       [=](auto& f) {
         resize(depth(f), {most, most});
       },
       kExhausted, kDepth + ".size"},
      {"depth of another size",
       [](auto& f) {
         resize(depth(f), {3, 3});
       },
       kInvalid, kDepth + ".size"},
      {"colour in a depth plane", [](auto& f) { depth(f).encoding = PlaneEncoding::kRgba8; },
       kInvalid, kDepth + ".encoding"},
      {"depth in a colour plane", [](auto& f) { color(f).encoding = PlaneEncoding::kDepthU16; },
       kInvalid, kColor + ".encoding"},
      {"half beside 8 bit",
       [](auto& f) {
         color(f) = rawPlane(PlaneKind::kColor, PlaneEncoding::kRgba16f, {6, 4});
       },
       kInvalid, kColor + ".encoding"},
  });
}

TEST(ValidateFrame, namesTheFieldOfBytesThatDoNotFit) {
  const uint32_t most = std::numeric_limits<uint32_t>::max();
  expectRefusals({
      {"stride below a row", [](auto& f) { color(f).stride_bytes = 23; }, kInvalid,
       kColor + ".stride_bytes"},
      {"huge stride", [=](auto& f) { color(f).stride_bytes = most; }, kInvalid,
       kColor + ".stride_bytes"},
      {"JPEG with a stride",
       [](auto& f) {
         color(f).encoding = PlaneEncoding::kJpeg;
         color(f).stride_bytes = 24;
       },
       kInvalid, kColor + ".stride_bytes"},
      {"one byte short", [](auto& f) { --depth(f).wire_bytes; }, kInvalid, kDepth + ".bytes_count"},
      {"one byte too long", [](auto& f) { ++color(f).wire_bytes; }, kInvalid,
       kColor + ".bytes_count"},
      {"no bytes of zstd",
       [](auto& f) {
         color(f).compression = PlaneCompression::kZstd;
         color(f).wire_bytes = 0;
       },
       kInvalid, kColor + ".bytes_count"},
      {"zstd larger than any encoder makes it",
       [](auto& f) {
         depth(f).compression = PlaneCompression::kZstd;
         depth(f).wire_bytes += 2000;
       },
       kInvalid, kDepth + ".bytes_count"},
      {"prediction of what has no 16 bits",
       [](auto& f) { depth(f).compression = PlaneCompression::kPredictedZstd; }, kInvalid,
       kDepth + ".compression"},
      {"prediction of colour",
       [](auto& f) { color(f).compression = PlaneCompression::kPredictedZstd; }, kInvalid,
       kColor + ".compression"},
      {"prediction over padded rows",
       [](auto& f) {
         depth(f).encoding = PlaneEncoding::kDepthU16;
         depth(f).compression = PlaneCompression::kPredictedZstd;
         depth(f).stride_bytes = 64;
       },
       kInvalid, kDepth + ".stride_bytes"},
      {"prediction larger than any encoder makes it",
       [](auto& f) {
         depth(f).encoding = PlaneEncoding::kDepthU16;
         depth(f).compression = PlaneCompression::kPredictedZstd;
         depth(f).wire_bytes += 2000;
       },
       kInvalid, kDepth + ".bytes_count"},
      {"endless JPEG",
       [](auto& f) {
         color(f).encoding = PlaneEncoding::kJpeg;
         color(f).wire_bytes = uint64_t{1} << 63;
       },
       kInvalid, kColor + ".bytes_count"},
      {"depth without scale", [](auto& f) { depth(f).depth.scale = 0; }, kInvalid,
       kDepth + ".depth.scale"},
  });
}

TEST(ValidateFrame, countsPlanesAsTheyCameOnTheWire) {
  FrameFormat frame = goodFrame();
  frame.sources[0].layers[0].depth_first = true;
  frame.sources[0].layers[0].depth.wire_bytes = 1;
  EXPECT_EQ(fieldOf(validateFrame(frame, {})), "header.sources[0].layers[0].planes[0].bytes_count");
}

TEST(ValidateFrame, addsUpAllPlanesAgainstTheLimit) {
  const FrameFormat frame = goodFrame();
  // Two layers of 6x4 RGBA8 and 3x2 binary32.
  const uint64_t bytes = 2 * (6 * 4 * 4 + 3 * 2 * 4);
  EXPECT_TRUE(validateFrame(frame, {.frame_bytes_max = bytes}).ok());
  const absl::Status status = validateFrame(frame, {.frame_bytes_max = bytes - 1});
  EXPECT_EQ(status.code(), kExhausted);
  EXPECT_EQ(fieldOf(status), "header");
}

TEST(ValidateFrame, countsWhatRgbGrowsTo) {
  FrameFormat frame = goodFrame();
  frame.sources[0].layers.resize(1);
  frame.sources[0].layers[0].color = rawPlane(PlaneKind::kColor, PlaneEncoding::kRgb8, {6, 4});
  const uint64_t bytes = 6 * 4 * 4 + 3 * 2 * 4;
  EXPECT_TRUE(validateFrame(frame, {.frame_bytes_max = bytes}).ok());
  EXPECT_FALSE(validateFrame(frame, {.frame_bytes_max = bytes - 1}).ok());
}

TEST(ValidateFrame, acceptsPaddedRows) {
  FrameFormat frame = goodFrame();
  color(frame).stride_bytes = 256;
  color(frame).wire_bytes = 4 * 256;
  EXPECT_TRUE(validateFrame(frame, {}).ok());
}

}  // namespace
}  // namespace viewloom::limits_test
