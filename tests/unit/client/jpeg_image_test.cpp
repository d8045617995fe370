// SPDX-License-Identifier: Apache-2.0
#include "files/jpeg_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <cstdlib>

#include "unit/client/test_files.h"

namespace viewloom::files::jpeg_image_test {
namespace {

using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

std::string compress(int width, int height, int pixel_format, int subsampling, int flags) {
  const int channels = tjPixelSize[pixel_format];
  std::vector<uint8_t> samples(static_cast<size_t>(width * height * channels));
  for (size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<uint8_t>(100 + i % 60);
  tjhandle handle = tjInitCompress();
  unsigned char* out = nullptr;
  unsigned long size = 0;
  EXPECT_EQ(tjCompress2(handle, samples.data(), width, 0, height, pixel_format, &out, &size,
                        subsampling, 95, flags),
            0)
      << tjGetErrorStr2(handle);
  std::string bytes(reinterpret_cast<char*>(out), size);
  tjFree(out);
  tjDestroy(handle);
  return bytes;
}

TEST(JpegImage, passesBaselineOnUntouched) {
  const TestFolder folder;
  const std::string bytes = compress(33, 17, TJPF_RGB, TJSAMP_420, 0);
  const auto image = readJpegColor(folder.write("a.jpg", bytes));
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->encoding, v1::PLANE_ENCODING_JPEG);
  EXPECT_EQ(image->width_px, 33U);
  EXPECT_EQ(image->height_px, 17U);
  EXPECT_THAT(image->bytes, ElementsAreArray(std::vector<uint8_t>(bytes.begin(), bytes.end())));
}

TEST(JpegImage, decodesProgressiveFiles) {
  const TestFolder folder;
  const auto image = readJpegColor(
      folder.write("p.jpg", compress(16, 8, TJPF_GRAY, TJSAMP_GRAY, TJFLAG_PROGRESSIVE)));
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->encoding, v1::PLANE_ENCODING_RGB8);
  ASSERT_EQ(image->bytes.size(), 3U * 16 * 8);
  EXPECT_NEAR(image->bytes[0], 100, 4);  // quality 95
  EXPECT_EQ(image->bytes[0], image->bytes[2]);
}

TEST(JpegImage, refusesCmyk) {
  const TestFolder folder;
  const auto image = readJpegColor(folder.write("c.jpg", compress(8, 8, TJPF_CMYK, TJSAMP_444, 0)));
  EXPECT_THAT(std::string(image.status().message()), HasSubstr("is a CMYK JPEG"));
}

TEST(JpegImage, refusesWhatIsNoJpegAndTruncatedProgressiveFiles) {
  const TestFolder folder;
  EXPECT_THAT(std::string(readJpegColor(folder.write("x.jpg", "GIF89a")).status().message()),
              HasSubstr("is no JPEG that can be read"));
  EXPECT_FALSE(readJpegColor(folder.write("x.jpg", "")).ok());
  const std::string bytes = compress(64, 64, TJPF_RGB, TJSAMP_420, TJFLAG_PROGRESSIVE);
  const auto image = readJpegColor(folder.write("x.jpg", bytes.substr(0, bytes.size() / 2)));
  EXPECT_THAT(std::string(image.status().message()), HasSubstr("ends before its picture is whole"));
}

TEST(JpegImage, refusesBaselineFilesThatAreCutShort) {
  const TestFolder folder;
  const std::string bytes = compress(64, 64, TJPF_RGB, TJSAMP_420, 0);
  for (const size_t count : {bytes.size() / 2, bytes.size() - 2}) {
    const auto image = readJpegColor(folder.write("x.jpg", bytes.substr(0, count)));
    EXPECT_THAT(std::string(image.status().message()), HasSubstr("still being written"));
  }
}

TEST(JpegImage, readsTheFirstPictureOfSeveral) {
  const TestFolder folder;
  const std::string first = compress(16, 8, TJPF_RGB, TJSAMP_420, 0);
  const auto image =
      readJpegColor(folder.write("a.mpo", first + compress(64, 64, TJPF_RGB, TJSAMP_420, 0)));
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->width_px, 16U);
  EXPECT_EQ(image->bytes.size(), first.size());
}

TEST(JpegImage, refusesSidesBeyondTheLimit) {
  const TestFolder folder;
  const auto image =
      readJpegColor(folder.write("wide.jpg", compress(8200, 1, TJPF_GRAY, TJSAMP_GRAY, 0)));
  EXPECT_THAT(std::string(image.status().message()), HasSubstr("8200x1 px; accepted is 1..8192"));
}

}  // namespace
}  // namespace viewloom::files::jpeg_image_test
