// SPDX-License-Identifier: Apache-2.0
// JPEG photos with depth inside, against the colours and distances that they were written with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>

#include "absl/strings/escaping.h"
#include "photos/photo.h"
#include "unit/client/test_files.h"
#include "unit/client/written_pictures.h"
#include "unit/inputs/written_files.h"
#include "unit/photos/written_photo.h"

namespace viewloom::test::jpeg_photo_test {
namespace {

using files::TestFolder;
using inputs::InputKind;
using ::testing::Contains;
using ::testing::HasSubstr;

std::string bigEndian(size_t number, int byte_count) {
  std::string bytes;
  for (int i = byte_count - 1; i >= 0; --i) bytes += static_cast<char>(number >> (8 * i));
  return bytes;
}

std::string segment(char marker, const std::string& body) {
  return std::string("\xff") + marker + bigEndian(body.size() + 2, 2) + body;
}

std::string xmpSegment(const std::string& xml) {
  return segment('\xe1', std::string("http://ns.adobe.com/xap/1.0/\0", 29) + xml);
}

// In parts of at most 200 bytes, though a segment could hold more.
std::string extendedXmp(const std::string& xml) {
  std::string segments;
  for (size_t at = 0; at < xml.size(); at += 200) {
    segments += segment('\xe1', std::string("http://ns.adobe.com/xmp/extension/\0", 35) +
                                    std::string(32, 'A') + bigEndian(xml.size(), 4) +
                                    bigEndian(at, 4) + xml.substr(at, 200));
  }
  return segments;
}

std::string depthMap(const std::string& format, const std::string& near_far) {
  return "<x:xmpmeta><rdf:Description xmlns:GDepth=\"http://ns.google.com/photos/1.0/depthmap/\" "
         "GDepth:Format=\"" +
         format + "\" GDepth:Mime=\"image/png\" " + near_far + "/></x:xmpmeta>";
}

class JpegPhotoTest : public ::testing::Test {
 protected:
  // 16x8 px, all one colour.
  static std::string color(const std::string& exif = "") {
    return files::writtenJpeg(16, 8, std::vector<uint8_t>(3 * 16 * 8, 90), exif);
  }
  // Codes 0, 51, 255 and 102 in 2x2 px.
  static std::string depthPng() {
    return files::writtenPng(2, 2, PNG_COLOR_TYPE_GRAY, 8, {0, 51, 255, 102});
  }
  std::string googlePhoto(const std::string& format, const std::string& near_far) const {
    std::string base64;
    absl::Base64Escape(depthPng(), &base64);
    std::string bytes = color();
    bytes.insert(2, xmpSegment(depthMap(format, near_far)) +
                        extendedXmp(depthMap(format, "GDepth:Data=\"" + base64 + "\"")));
    return folder_.write("IMG_1.jpg", bytes).string();
  }
  // The second picture, 16x16 px of one code, behind the first, as its index says.
  std::string applePhoto(const std::string& xmp, const std::string& exif = "") const {
    std::string second = files::writtenJpeg(16, 16, std::vector<uint8_t>(3 * 16 * 16, 51));
    second.insert(2, xmpSegment(xmp));
    std::string first = color(exif);
    // One directory: tag 0xB002 of 32 bytes, which lie behind it.
    const size_t index_bytes = 8 + 2 + 12 + 4 + 32;
    const size_t index_at = 2 + 4 + 4;  // SOI, marker and length, "MPF\0"
    const size_t first_bytes = first.size() + 4 + 4 + index_bytes;
    const std::string index =
        std::string("MM\0*\0\0\0\x08\0\x01\xb0\x02\0\x07\0\0\0\x20\0\0\0\x1a\0\0\0\0", 26) +
        bigEndian(0x030000, 4) + bigEndian(first_bytes, 4) + bigEndian(0, 4) + bigEndian(0, 4) +
        bigEndian(0, 4) + bigEndian(second.size(), 4) + bigEndian(first_bytes - index_at, 4) +
        bigEndian(0, 4);
    first.insert(2, segment('\xe2', std::string("MPF\0", 4) + index));
    return folder_.write("IMG_2.JPG", first + second).string();
  }

  const TestFolder folder_;
};

TEST_F(JpegPhotoTest, readsTheDepthMapOfXmp) {
  const auto inverse =
      readInput({}, {.color = googlePhoto("RangeInverse", "GDepth:Near=\"0.5\" GDepth:Far=\"4\"")});
  EXPECT_EQ(inverse.how.kind, InputKind::kIphone);
  EXPECT_NEAR(depthAt(inverse, 0, 0), 0.5, 1e-5);
  EXPECT_NEAR(depthAt(inverse, 1, 0), 1 / (2 - 0.2 * 1.75), 1e-5);
  EXPECT_NEAR(depthAt(inverse, 0, 1), 4, 1e-4);
  EXPECT_EQ(inverse.frame.wire.header.sources(0).layers(0).planes(0).size().width(), 16U);
  const auto linear =
      readInput({}, {.color = googlePhoto("RangeLinear",
                                          "GDepth:Near=\"500\" "
                                          "GDepth:Far=\"4000\" GDepth:Units=\"mm\"")});
  EXPECT_NEAR(depthAt(linear, 1, 0), 0.5 + 0.2 * 3.5, 1e-5);
}

TEST_F(JpegPhotoTest, readsTheAuxiliaryPictureOfAPortrait) {
  const auto photo = readInput({}, {.color = applePhoto(appleXmp("disparity", "0.25", "1.525"))});
  EXPECT_NEAR(1 / depthAt(photo, 8, 8), 0.25 + 0.005 * 51, 0.006);
  EXPECT_THAT(photo.how.notes, Contains(HasSubstr("auxiliary picture of disparity")));
}

TEST_F(JpegPhotoTest, turnsColourAndDepthAlike) {
  const auto photo = readInput(
      {}, {.color = applePhoto(appleXmp("disparity", "0.25", "1.525"), files::exifOrientation(6))});
  const v1::Layer& layer = photo.frame.wire.header.sources(0).layers(0);
  EXPECT_EQ(layer.planes(0).size().width(), 8U);
  EXPECT_EQ(layer.planes(0).size().height(), 16U);
}

TEST_F(JpegPhotoTest, leavesOtherJpegsAlone) {
  EXPECT_FALSE(photos::isPhoto(folder_.write("plain.jpg", color()).string()));
  EXPECT_FALSE(photos::isPhoto(applePhoto("<x:xmpmeta/>"))) << "a second picture that is no depth";
  EXPECT_TRUE(photos::isPhoto(googlePhoto("RangeInverse", "")));
  EXPECT_THAT(refusalOf({}, {.color = googlePhoto("RangeInverse", "")}),
              HasSubstr("without the distances of its codes; give --depth-near"));
}

}  // namespace
}  // namespace viewloom::test::jpeg_photo_test
