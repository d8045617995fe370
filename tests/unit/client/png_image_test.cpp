// SPDX-License-Identifier: Apache-2.0
#include "files/png_image.h"

#include <Imath/half.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cstring>
#include <fstream>

#include "unit/client/test_files.h"

namespace viewloom::files::png_image_test {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

// Writes with libpng's own row interface, apart from the writer under test.
std::filesystem::path writePng(const TestFolder& folder, int width, int height, int bits,
                               int color_type, const std::vector<uint8_t>& samples,
                               int interlace = PNG_INTERLACE_NONE) {
  const std::filesystem::path path = folder.path() / "written.png";
  std::FILE* file = std::fopen(path.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits,
               color_type, interlace, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const size_t row_bytes = png_get_rowbytes(png, info);
  std::vector<uint8_t> copy = samples;
  std::vector<png_bytep> rows;
  for (int y = 0; y < height; ++y) rows.push_back(&copy[row_bytes * static_cast<size_t>(y)]);
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
  return path;
}

TEST(PngImage, keeps8BitColourAsStored) {
  const TestFolder folder;
  const std::vector<uint8_t> rgba{1, 2, 3, 4, 5, 6, 7, 8};
  const auto image = readPngColor(writePng(folder, 2, 1, 8, PNG_COLOR_TYPE_RGBA, rgba), false);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->encoding, v1::PLANE_ENCODING_RGBA8);
  EXPECT_TRUE(image->has_alpha);
  EXPECT_THAT(image->bytes, ElementsAreArray(rgba));
}

TEST(PngImage, spreadsGreyToColour) {
  const TestFolder folder;
  const auto image = readPngColor(writePng(folder, 2, 1, 8, PNG_COLOR_TYPE_GRAY, {9, 200}), false);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->encoding, v1::PLANE_ENCODING_RGB8);
  EXPECT_THAT(image->bytes, ElementsAre(9, 9, 9, 200, 200, 200));
}

TEST(PngImage, decodes16BitColourToLinearLight) {
  const TestFolder folder;
  const auto file = writePng(folder, 1, 1, 16, PNG_COLOR_TYPE_RGB, {0x80, 0x00, 0xFF, 0xFF, 0, 0});
  Imath::half rgba[4];
  const auto srgb = readPngColor(file, false);
  ASSERT_TRUE(srgb.ok()) << srgb.status();
  ASSERT_EQ(srgb->bytes.size(), sizeof(rgba));
  std::memcpy(static_cast<void*>(rgba), srgb->bytes.data(), sizeof(rgba));
  EXPECT_NEAR(rgba[0], 0.21404, 1e-4);  // the sRGB curve at 32768 / 65535
  EXPECT_EQ(rgba[1], 1.0F);
  EXPECT_EQ(rgba[3], 1.0F);
  const auto linear = readPngColor(file, true);
  ASSERT_TRUE(linear.ok()) << linear.status();
  std::memcpy(static_cast<void*>(rgba), linear->bytes.data(), sizeof(rgba));
  EXPECT_NEAR(rgba[0], 0.5, 5e-4);
}

TEST(PngImage, keeps16BitDepthLittleEndian) {
  const TestFolder folder;
  const auto image = readPngDepth(
      writePng(folder, 2, 1, 16, PNG_COLOR_TYPE_GRAY, {0x12, 0x34, 0xFF, 0x00}), false);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->encoding, v1::PLANE_ENCODING_DEPTH_U16);
  EXPECT_THAT(image->bytes, ElementsAre(0x34, 0x12, 0x00, 0xFF));
}

TEST(PngImage, widens8BitDepthByValueOrByRange) {
  const TestFolder folder;
  const auto file = writePng(folder, 2, 1, 8, PNG_COLOR_TYPE_GRAY, {7, 255});
  EXPECT_THAT(readPngDepth(file, false)->bytes, ElementsAre(7, 0, 255, 0));
  EXPECT_THAT(readPngDepth(file, true)->bytes, ElementsAre(7, 7, 255, 255));
}

TEST(PngImage, readsInterlacedFiles) {
  const TestFolder folder;
  std::vector<uint8_t> samples(3 * 11 * 9);
  for (size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<uint8_t>(7 * i);
  const auto image = readPngColor(
      writePng(folder, 11, 9, 8, PNG_COLOR_TYPE_RGB, samples, PNG_INTERLACE_ADAM7), false);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_THAT(image->bytes, ElementsAreArray(samples));
}

TEST(PngImage, refusesColourAsDepth) {
  const TestFolder folder;
  const auto file = writePng(folder, 1, 1, 8, PNG_COLOR_TYPE_RGB, {10, 200, 30});
  EXPECT_THAT(std::string(readPngDepth(file, false).status().message()),
              HasSubstr("is coloured; accepted as depth is grey of 8 or 16 bits"));
}

TEST(PngImage, readsGreyThatIsStoredAsColourAsDepth) {
  const TestFolder folder;
  const auto file = writePng(folder, 2, 1, 8, PNG_COLOR_TYPE_RGB, {9, 9, 9, 250, 250, 250});
  const auto image = readPngDepth(file, false);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_THAT(image->bytes, ElementsAre(9, 0, 250, 0));
}

TEST(PngImage, refusesTruncatedFilesAtEveryLength) {
  const TestFolder folder;
  const auto file = writePng(folder, 16, 16, 8, PNG_COLOR_TYPE_GRAY, std::vector<uint8_t>(256, 77));
  const size_t size = bytesOf(file).size();
  for (size_t count = 0; count < size; ++count) {
    ASSERT_FALSE(readPngColor(folder.truncated(file, count), false).ok())
        << count << " of " << size;
  }
}

TEST(PngImage, refusesHugeSizesBeforeReading) {
  const TestFolder folder;
  std::string bytes = bytesOf(writePng(folder, 1, 1, 8, PNG_COLOR_TYPE_GRAY, {1}));
  bytes[16] = 0x7F;  // the first byte of the width in IHDR
  const auto image = readPngColor(folder.write("huge.png", bytes), false);
  EXPECT_EQ(image.status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(PngWriter, writesWhatTheReaderReads) {
  const TestFolder folder;
  std::vector<uint8_t> samples(3 * 5 * 4);
  for (size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<uint8_t>(31 * i);
  const auto bytes = encodePng(samples, 5, 4, 3);
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  const auto image = readPngColor(folder.write("w.png", *bytes), false);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->width_px, 5U);
  EXPECT_EQ(image->height_px, 4U);
  EXPECT_THAT(image->bytes, ElementsAreArray(samples));
}

}  // namespace
}  // namespace viewloom::files::png_image_test
