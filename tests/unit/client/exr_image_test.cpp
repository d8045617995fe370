// SPDX-License-Identifier: Apache-2.0
#include "files/exr_image.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "unit/client/exr_samples.h"
#include "unit/client/test_files.h"

namespace viewloom::files::exr_image_test {
namespace {

using Imath::Box2i;
using Imath::half;
using Imath::V2i;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::filesystem::path writeExr(const TestFolder& folder, const Box2i& display, const Box2i& data,
                               const Channels& channels) {
  const std::filesystem::path path = folder.path() / "written.exr";
  const PartSamples samples(data, channels);
  Imf::OutputFile file(path.c_str(), samples.header(display));
  file.setFrameBuffer(samples.frameBuffer());
  file.writePixels(samples.height());
  return path;
}

half halfAt(const PlaneImage& image, uint32_t x, uint32_t y, size_t channel) {
  half value;
  std::memcpy(static_cast<void*>(&value),
              &image.bytes[8 * (size_t{y} * image.width_px + x) + 2 * channel], 2);
  return value;
}

float floatAt(const PlaneImage& image, uint32_t x, uint32_t y) {
  float value = 0;
  std::memcpy(&value, &image.bytes[4 * (size_t{y} * image.width_px + x)], 4);
  return value;
}

std::string messageOf(const absl::StatusOr<PlaneImage>& image) {
  return image.ok() ? "OK" : std::string(image.status().message());
}

TEST(ExrImage, interleavesChannelsWhateverTheirOrderInTheFile) {
  const TestFolder folder;
  const Box2i window(V2i(0, 0), V2i(4, 2));
  const auto image = readExrColor(writeExr(folder, window, window, {{"R", "G", "B", "A"}}), {});
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->encoding, v1::PLANE_ENCODING_RGBA16F);
  EXPECT_TRUE(image->has_alpha);
  for (size_t channel = 0; channel < 4; ++channel) {
    EXPECT_EQ(halfAt(*image, 3, 2, channel), half(sampleAt(channel, 3, 2)));
  }
}

TEST(ExrImage, readsSubsampledLuminanceAndChromaAsColour) {
  const TestFolder folder;
  const std::filesystem::path path = folder.path() / "chroma.exr";
  const int width_px = 8, height_px = 6;
  const std::vector<Imf::Rgba> pixels(width_px * height_px, Imf::Rgba(0.75F, 0.5F, 0.25F, 0.5F));
  for (const Imf::RgbaChannels channels : {Imf::WRITE_YC, Imf::WRITE_YCA}) {
    {
      Imf::RgbaOutputFile file(path.c_str(), width_px, height_px, channels);
      file.setFrameBuffer(pixels.data(), 1, width_px);
      file.writePixels(height_px);
    }
    const auto image = readExrColor(path, {});
    ASSERT_TRUE(image.ok()) << image.status();
    EXPECT_EQ(image->has_alpha, channels == Imf::WRITE_YCA);
    for (const uint32_t x : {0U, 3U, 7U}) {
      EXPECT_NEAR(halfAt(*image, x, 5, 0), 0.75F, 0.01F) << x;
      EXPECT_NEAR(halfAt(*image, x, 5, 1), 0.5F, 0.01F) << x;
      EXPECT_NEAR(halfAt(*image, x, 5, 2), 0.25F, 0.01F) << x;
      EXPECT_EQ(halfAt(*image, x, 5, 3), image->has_alpha ? 0.5F : 1) << x;
    }
  }
}

TEST(ExrImage, cropsToTheDisplayWindowAndLeavesTheRestEmpty) {
  const TestFolder folder;
  // The data window starts inside the display window, ends beyond it, and has a negative part.
  const Box2i display(V2i(-2, 10), V2i(7, 99));
  const Box2i data(V2i(1, 5), V2i(12, 120));
  const auto image = readExrDepth(writeExr(folder, display, data, {{"Z"}, Imf::FLOAT}), {});
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->encoding, v1::PLANE_ENCODING_DEPTH_F32);
  ASSERT_EQ(image->width_px, 10U);
  ASSERT_EQ(image->height_px, 90U);
  for (uint32_t y = 0; y < image->height_px; ++y) {
    for (uint32_t x = 0; x < image->width_px; ++x) {
      const int file_x = static_cast<int>(x) - 2;
      const int file_y = static_cast<int>(y) + 10;
      const float wanted = data.intersects(V2i(file_x, file_y)) ? sampleAt(0, file_x, file_y) : 0;
      ASSERT_EQ(floatAt(*image, x, y), wanted) << x << ", " << y;
    }
  }
}

TEST(ExrImage, isEmptyWhenTheWindowsDoNotMeet) {
  const TestFolder folder;
  const auto image = readExrDepth(writeExr(folder, Box2i(V2i(0, 0), V2i(3, 3)),
                                           Box2i(V2i(10, 0), V2i(12, 3)), {{"Z"}, Imf::FLOAT}),
                                  {});
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_THAT(image->bytes, ::testing::Each(0));
}

TEST(ExrImage, keepsHalfDepthAsHalf) {
  const TestFolder folder;
  const Box2i window(V2i(0, 0), V2i(1, 0));
  const auto image = readExrDepth(writeExr(folder, window, window, {{"Z"}, Imf::HALF}), {});
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->encoding, v1::PLANE_ENCODING_DEPTH_F16);
  EXPECT_EQ(image->bytes.size(), 4U);
}

TEST(ExrImage, spreadsGreyAndMakesAlphaOpaque) {
  const TestFolder folder;
  const Box2i window(V2i(0, 0), V2i(1, 0));
  const auto image = readExrColor(writeExr(folder, window, window, {{"Y"}, Imf::FLOAT}), {});
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_FALSE(image->has_alpha);
  for (size_t channel = 0; channel < 3; ++channel) EXPECT_EQ(halfAt(*image, 1, 0, channel), 1.0F);
  EXPECT_EQ(halfAt(*image, 1, 0, 3), 1.0F);
}

TEST(ExrImage, makesColourFinite) {
  const TestFolder folder;
  const std::filesystem::path path = folder.path() / "inf.exr";
  const float samples[3] = {std::numeric_limits<float>::infinity(),
                            std::numeric_limits<float>::quiet_NaN(), -1e9F};
  Imf::Header header(3, 1);
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  {
    Imf::OutputFile file(path.c_str(), header);
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, samples, V2i(0, 0), 3, 1));
    file.setFrameBuffer(buffer);
    file.writePixels(1);
  }
  const auto image = readExrColor(path, {});
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(halfAt(*image, 0, 0, 0), 65504.0F);
  EXPECT_EQ(halfAt(*image, 1, 0, 0), 0.0F);
  EXPECT_EQ(halfAt(*image, 2, 0, 0), -65504.0F);
}

TEST(ExrImage, findsTheViewsOfAMultiViewFile) {
  const TestFolder folder;
  const Box2i window(V2i(0, 0), V2i(3, 0));
  const std::filesystem::path path = folder.path() / "views.exr";
  const PartSamples samples(window, {{"R", "G", "B", "Z", "left.R", "left.G", "left.B", "left.Z"}});
  Imf::Header header = samples.header(window);
  Imf::addMultiView(header, {"right", "left"});
  {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(samples.frameBuffer());
    file.writePixels(1);
  }
  const auto left = exrChannelsOfView(path, "left");
  ASSERT_TRUE(left.ok()) << left.status();
  EXPECT_THAT(left->color, ElementsAre("left.R", "left.G", "left.B"));
  EXPECT_THAT(left->depth, ElementsAre("left.Z"));
  const auto image = readExrColor(path, left->color);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(halfAt(*image, 2, 0, 0), half(sampleAt(4, 2, 0)));
  // The default view has no prefix in the file, and may be asked for by its name.
  const auto right = exrChannelsOfView(path, "right");
  ASSERT_TRUE(right.ok()) << right.status();
  const auto depth = readExrDepth(path, right->depth);
  ASSERT_TRUE(depth.ok()) << depth.status();
  EXPECT_THAT(std::string(exrChannelsOfView(path, "middle").status().message()),
              HasSubstr("has no view middle; accepted are right, left; its channels are"));
}

TEST(ExrImage, findsTheViewsOfAMultiPartFile) {
  const TestFolder folder;
  const Box2i window(V2i(0, 0), V2i(3, 0));
  const std::filesystem::path path = folder.path() / "parts.exr";
  const PartSamples color(window, {{"R", "G", "B"}});
  const PartSamples depth(window, {{"G", "R", "Z"}, Imf::FLOAT});
  std::vector<Imf::Header> headers{color.header(window), depth.header(window)};
  headers[0].setName("beauty");
  headers[1].setName("left eye");
  headers[1].setView("left");
  for (Imf::Header& header : headers) header.setType(Imf::SCANLINEIMAGE);
  {
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2);
    Imf::OutputPart first(file, 0);
    first.setFrameBuffer(color.frameBuffer());
    first.writePixels(1);
    Imf::OutputPart second(file, 1);
    second.setFrameBuffer(depth.frameBuffer());
    second.writePixels(1);
  }
  const std::vector<std::string> of_view{"left.Z"};
  const auto image = readExrDepth(path, of_view);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(floatAt(*image, 1, 0), sampleAt(2, 1, 0));
  EXPECT_TRUE(readExrDepth(path, {}).ok()) << "Z is in one part only";
  EXPECT_TRUE(readExrColor(path, {}).ok());
  const std::vector<std::string> mixed{"R", "G", "left.Z"};
  EXPECT_THAT(messageOf(readExrColor(path, mixed)), HasSubstr("of different parts"));
}

TEST(ExrImage, readsTiledFiles) {
  const TestFolder folder;
  const Box2i window(V2i(3, 2), V2i(82, 101));
  const std::filesystem::path path = folder.path() / "tiled.exr";
  const PartSamples samples(window, {{"Z"}, Imf::FLOAT});
  Imf::Header header = samples.header(window);
  header.setTileDescription(Imf::TileDescription(32, 24));
  {
    Imf::TiledOutputFile file(path.c_str(), header);
    file.setFrameBuffer(samples.frameBuffer());
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
  }
  const auto image = readExrDepth(path, {});
  ASSERT_TRUE(image.ok()) << image.status();
  for (uint32_t y = 0; y < image->height_px; ++y) {
    ASSERT_EQ(floatAt(*image, 70, y), sampleAt(0, 73, static_cast<int>(y) + 2));
  }
}

TEST(ExrImage, saysWhichChannelsThereAre) {
  const TestFolder folder;
  const Box2i window(V2i(0, 0), V2i(1, 0));
  std::filesystem::path file;
  const std::vector<std::string> missing{"depth.Q"};
  EXPECT_THAT(messageOf(readExrDepth(writeExr(folder, window, window, {{"a"}}), {})),
              HasSubstr("name another with --depth-channel; it has a"));
  file = writeExr(folder, window, window, {{"albedo", "Z"}, Imf::UINT});
  EXPECT_THAT(messageOf(readExrDepth(file, missing)),
              HasSubstr("has no channel depth.Q; it has Z, albedo"));
  EXPECT_THAT(messageOf(readExrColor(file, {})), HasSubstr("it has Z, albedo"));
  EXPECT_EQ(readExrDepth(file, {})->encoding, v1::PLANE_ENCODING_DEPTH_F32) << "of integers";
}

TEST(ExrImage, refusesDisplayWindowsBeyondTheLimit) {
  const TestFolder folder;
  const Box2i data(V2i(0, 0), V2i(1, 1));
  const auto file = writeExr(folder, Box2i(V2i(0, 0), V2i(8192, 3)), data, {{"Z"}, Imf::FLOAT});
  EXPECT_THAT(messageOf(readExrDepth(file, {})), HasSubstr("8193x4 px; accepted is 1..8192"));
}

TEST(ExrImage, refusesHostileDataWindowsBeforeReading) {
  const TestFolder folder;
  const Box2i window(V2i(0, 0), V2i(3, 3));
  std::string bytes = bytesOf(writeExr(folder, window, window, {{"Z"}, Imf::FLOAT}));
  const std::string name("dataWindow\0box2i\0", 17);
  const size_t at = bytes.find(name);
  ASSERT_NE(at, std::string::npos);
  bytes[at + name.size() + 4 + 12 + 3] = 0x3F;  // the highest byte of max.y: a billion rows
  EXPECT_THAT(messageOf(readExrDepth(folder.write("huge.exr", bytes), {})),
              HasSubstr("is no EXR file to be read"));
}

TEST(ExrImage, refusesTruncatedFilesAtEveryLength) {
  const TestFolder folder;
  const Box2i window(V2i(0, 0), V2i(7, 40));
  const auto file = writeExr(folder, window, window, {{"Z"}, Imf::FLOAT});
  const size_t size = bytesOf(file).size();
  for (size_t count = 0; count < size; count += 7) {
    ASSERT_FALSE(readExrDepth(folder.truncated(file, count), {}).ok()) << count << " of " << size;
  }
}

}  // namespace
}  // namespace viewloom::files::exr_image_test
