// SPDX-License-Identifier: Apache-2.0
#include "lib/color_coder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <vector>

#include "lib/compress_frame.h"
#include "video/openh264_decoder.h"
#include "video/still_pictures.h"
#include "video/view_colors.h"

namespace viewloom::color_coder_test {
namespace {

using Bytes = std::vector<uint8_t>;

SharedBytes sharedOf(Bytes bytes) {
  return std::make_shared<const Bytes>(std::move(bytes));
}

uint8_t wave(double x, double y, size_t channel) {
  return uint8_t(
      std::lround(128 + 60 * std::sin(x / 21 + double(channel)) + 50 * std::cos(y / 33)));
}

// A source of one layer: smooth colour, and depth in metres with a hole of no surface.
struct OneLayer {
  explicit OneLayer(SizePx size, size_t pixel_bytes = 3) : size_px(size) {
    color.resize(size_px.area() * pixel_bytes, 255);
    std::vector<float> depth_m(size_px.area(), 2);
    for (uint32_t y = 0; y < size_px.height; ++y) {
      for (uint32_t x = 0; x < size_px.width; ++x) {
        const size_t pixel = size_t{y} * size_px.width + x;
        for (size_t c = 0; c < 3; ++c) color[pixel_bytes * pixel + c] = wave(x, y, c);
        if (!isSurface(x, y)) depth_m[pixel] = 0;
      }
    }
    Bytes depth(depth_m.size() * sizeof(float));
    std::memcpy(depth.data(), depth_m.data(), depth.size());
    v1::Source& source = *frame.header.add_sources();
    source.mutable_camera()->mutable_intrinsics()->set_focal_x_px(100);
    source.mutable_camera()->mutable_intrinsics()->set_focal_y_px(100);
    v1::Layer& layer = *source.add_layers();
    add(layer, v1::PLANE_KIND_COLOR,
        pixel_bytes == 3 ? v1::PLANE_ENCODING_RGB8 : v1::PLANE_ENCODING_RGBA8, color);
    add(layer, v1::PLANE_KIND_DEPTH, v1::PLANE_ENCODING_DEPTH_F32, depth);
    layer.mutable_planes(1)->mutable_depth()->set_meaning(v1::DEPTH_MEANING_PLANAR);
  }

  static bool isSurface(uint32_t x, uint32_t y) { return x < 20 || y < 12; }
  v1::Plane& plane() {
    return *frame.header.mutable_sources(0)->mutable_layers(0)->mutable_planes(0);
  }

  SizePx size_px;
  Bytes color;
  WireFrame frame;

 private:
  void add(v1::Layer& layer, v1::PlaneKind kind, v1::PlaneEncoding encoding, Bytes bytes) {
    v1::Plane& plane = *layer.add_planes();
    plane.set_kind(kind);
    plane.set_encoding(encoding);
    plane.mutable_size()->set_width(size_px.width);
    plane.mutable_size()->set_height(size_px.height);
    plane.set_bytes_count(bytes.size());
    frame.planes.push_back(sharedOf(std::move(bytes)));
  }
};

// RGB of a coded plane.
Bytes decoded(const Bytes& wire, SizePx size_px) {
  const auto pictures = stillPicturesOf(wire, size_px);
  EXPECT_TRUE(pictures.ok()) << pictures.status();
  const auto decoder = OpenH264Decoder::make();
  Bytes rgb(size_px.area() * 3);
  uint32_t row = 0;
  for (const StillPicture& still : *pictures) {
    const auto picture = (*decoder)->decode(still.access_unit, still.size_px);
    EXPECT_TRUE(picture.ok()) << picture.status();
    const uint32_t row_count = std::min(still.size_px.height, size_px.height - row);
    writeViewColors(*picture, {.view_px = {size_px.width, row_count}},
                    &rgb[size_t{3} * row * size_px.width], size_t{3} * size_px.width);
    row += row_count;
  }
  return rgb;
}

TEST(ColorCoder, codesColorOfSurfacesWithinTwoCodes) {
  for (const SizePx size_px : {SizePx{16, 16}, SizePx{97, 61}, SizePx{256, 320}}) {
    for (const size_t pixel_bytes : {3, 4}) {
      OneLayer sent(size_px, pixel_bytes);
      const SharedBytes depth = sent.frame.planes[1];
      ColorCoder({.qp = 20}).code(sent.frame);
      ASSERT_EQ(sent.plane().encoding(), v1::PLANE_ENCODING_H264);
      ASSERT_EQ(sent.plane().bytes_count(), sent.frame.planes[0]->size());
      EXPECT_EQ(sent.frame.planes[1], depth) << "depth stays as it is";
      const Bytes rgb = decoded(*sent.frame.planes[0], size_px);
      double squares = 0, sum = 0, count = 0;
      for (uint32_t y = 0; y < size_px.height; ++y) {
        for (uint32_t x = 0; x < size_px.width; ++x) {
          if (!OneLayer::isSurface(x, y)) continue;
          const size_t pixel = size_t{y} * size_px.width + x;
          for (size_t c = 0; c < 3; ++c) {
            const double error =
                double{1} * rgb[3 * pixel + c] - sent.color[pixel_bytes * pixel + c];
            squares += error * error;
            sum += error;
            count += 1;
          }
        }
      }
      EXPECT_LT(std::sqrt(squares / count), 2.5) << size_px.width;
      EXPECT_LT(std::abs(sum / count), 1);
    }
  }
}

TEST(ColorCoder, readsRowsWithStride) {
  OneLayer packed({48, 32});
  OneLayer padded({48, 32});
  constexpr size_t kRow = 48 * 3, kStride = kRow + 20;
  Bytes rows(kStride * 32, 77);
  for (size_t y = 0; y < 32; ++y) std::copy_n(&packed.color[y * kRow], kRow, &rows[y * kStride]);
  padded.frame.planes[0] = sharedOf(rows);
  padded.plane().set_stride_bytes(kStride);
  padded.plane().set_bytes_count(rows.size());
  ColorCoder({}).code(packed.frame);
  ColorCoder({}).code(padded.frame);
  EXPECT_EQ(*padded.frame.planes[0], *packed.frame.planes[0]);
  EXPECT_EQ(padded.plane().stride_bytes(), 0U);
}

TEST(ColorCoder, cutsPlanesThatExceedThePicturesOfH264) {
  OneLayer large({8192, 1250});
  ColorCoder({.qp = 51}).code(large.frame);
  ASSERT_EQ(large.plane().encoding(), v1::PLANE_ENCODING_H264);
  const auto pictures = stillPicturesOf(*large.frame.planes[0], large.size_px);
  ASSERT_TRUE(pictures.ok()) << pictures.status();
  ASSERT_EQ(pictures->size(), 2U);
  EXPECT_EQ((*pictures)[0].size_px, (SizePx{8192, 640}));
  EXPECT_EQ((*pictures)[1].size_px, (SizePx{8192, 610}));
}

TEST(ColorCoder, codesEachFrameAlone) {
  ColorCoder coder({});
  OneLayer first({64, 64}), second({64, 64});
  coder.code(first.frame);
  coder.code(second.frame);
  const auto pictures = stillPicturesOf(*second.frame.planes[0], {64, 64});
  EXPECT_TRUE(pictures.ok()) << pictures.status();
}

TEST(ColorCoder, leavesPlanesThatVideoWouldHarm) {
  struct Case {
    const char* name;
    size_t pixel_bytes;
    SizePx size_px;
    std::function<void(v1::Plane&)> change;
  };
  const std::vector<Case> cases = {
      {"small", 3, {15, 64}, [](v1::Plane&) {}},
      {"fewer px than asked for", 3, {16, 16}, [](v1::Plane&) {}},
      {"an alpha that counts",
       4,
       {64, 64},
       [](v1::Plane& plane) { plane.set_alpha(v1::ALPHA_MODE_STRAIGHT); }},
      {"linear",
       3,
       {64, 64},
       [](v1::Plane& plane) { plane.set_transfer(v1::COLOR_TRANSFER_LINEAR); }},
      {"JPEG", 3, {64, 64}, [](v1::Plane& plane) { plane.set_encoding(v1::PLANE_ENCODING_JPEG); }},
      {"compressed",
       3,
       {64, 64},
       [](v1::Plane& plane) { plane.set_compression(v1::PLANE_COMPRESSION_ZSTD); }},
      {"of another size",
       3,
       {64, 64},
       [](v1::Plane& plane) { plane.mutable_size()->set_width(65); }},
  };
  for (const Case& one : cases) {
    OneLayer sent(one.size_px, one.pixel_bytes);
    one.change(sent.plane());
    const v1::PlaneEncoding encoding = sent.plane().encoding();
    const SharedBytes bytes = sent.frame.planes[0];
    ColorCoder({.area_min_px = 300}).code(sent.frame);
    EXPECT_EQ(sent.plane().encoding(), encoding) << one.name;
    EXPECT_EQ(sent.frame.planes[0], bytes) << one.name;
  }
}

TEST(ColorCoder, isNotCompressedOnceMore) {
  OneLayer sent({64, 64});
  ColorCoder({}).code(sent.frame);
  const SharedBytes video = sent.frame.planes[0];
  const CompressedFrame compressed =
      compressFrame(sent.frame, {.zstd_level = 3, .predicts_depth = true});
  EXPECT_EQ(compressed.frame.planes[0], video);
  EXPECT_EQ(compressed.frame.header.sources(0).layers(0).planes(1).encoding(),
            v1::PLANE_ENCODING_DEPTH_U16);
}

}  // namespace
}  // namespace viewloom::color_coder_test
