// SPDX-License-Identifier: Apache-2.0
// XMP, Exif and ICC of photos, as various programs write them, and of any length.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/exif.h"
#include "files/icc_profile.h"
#include "photos/depth_xmp.h"
#include "photos/heif_image.h"
#include "unit/photos/written_photo.h"

namespace viewloom::test::photo_metadata_test {
namespace {

using files::focal35mm;
using photos::DepthXmp;
using photos::parseDepthXmp;

TEST(DepthXmp, readsElements) {
  const DepthXmp xmp = parseDepthXmp(appleXmp("disparity", "0.976562", " 2.806641\n"));
  EXPECT_EQ(xmp.image_type, "disparity");
  EXPECT_EQ(xmp.accuracy, "relative");
  EXPECT_EQ(xmp.float_min, 0.976562);
  EXPECT_EQ(xmp.float_max, 2.806641);
  EXPECT_EQ(xmp.int_min, 0);
  EXPECT_EQ(xmp.int_max, 255);
}

TEST(DepthXmp, readsAttributesUnderAnyPrefix) {
  const DepthXmp xmp = parseDepthXmp(
      "<rdf:Description xmlns:p = 'http://ns.apple.com/pixeldatainfo/1.0/' "
      "p:AuxiliaryImageType='depth' p:FloatMaxValue = \"5e0\"\np:FloatMinValue='-1'/>");
  EXPECT_EQ(xmp.image_type, "depth");
  EXPECT_EQ(xmp.float_max, 5);
  EXPECT_EQ(xmp.float_min, -1);
  EXPECT_FALSE(xmp.int_min);
  EXPECT_EQ(xmp.accuracy, "");
}

TEST(DepthXmp, takesNoNumberFromWhatIsNone) {
  EXPECT_FALSE(parseDepthXmp(appleXmp("disparity", "inf", "nan")).float_min);
  EXPECT_FALSE(parseDepthXmp(appleXmp("disparity", "1/2", "")).float_max);
  EXPECT_EQ(parseDepthXmp("apdi:FloatMinValue=\"1\" apdi:AuxiliaryImageType=\"depth\"").image_type,
            "")
      << "a prefix that is bound to nothing";
}

TEST(DepthXmp, endsWithItsBytes) {
  const std::string whole = appleXmp("disparity", "0.25", "1.5");
  for (size_t length = 0; length < whole.size(); ++length) {
    const DepthXmp xmp = parseDepthXmp(whole.substr(0, length));
    EXPECT_EQ(xmp.float_min.value_or(0.25), 0.25) << length;
  }
}

// Little endian: an entry before, a long for the focal length.
TEST(ExifFocal, readsBothByteOrders) {
  const Bytes little{'I', 'I', 42,   0,    8,    0, 0, 0, 2, 0, 0x12, 0x01, 3, 0, 1, 0, 0, 0, 6,
                     0,   0,   0,    0x69, 0x87, 4, 0, 1, 0, 0, 0,    38,   0, 0, 0, 0, 0, 0, 0,
                     1,   0,   0x05, 0xA4, 4,    0, 1, 0, 0, 0, 77,   0,    0, 0, 0, 0, 0, 0};
  EXPECT_EQ(focal35mm(little), 77);
  Bytes item{0, 0, 0, 2, 'x', 'x'};
  item.insert(item.end(), little.begin(), little.end());
  EXPECT_EQ(focal35mm(files::tiffOfItem(item)), 77);
  for (size_t length = 0; length < 52; ++length) {
    const auto cut = focal35mm(std::span(little).first(length));
    EXPECT_TRUE(!cut || length >= 50) << length;
  }
  Bytes unknown = little;
  unknown[48] = 0;
  EXPECT_FALSE(focal35mm(unknown)) << "0 is unknown";
  Bytes far = little;
  far[33] = 0xFF;
  EXPECT_FALSE(focal35mm(far)) << "a directory beyond the end";
  EXPECT_TRUE(files::tiffOfItem(Bytes{255, 255, 255, 255, 0}).empty());
  EXPECT_TRUE(files::tiffOfItem(Bytes{0, 0}).empty());
}

TEST(IccPrimaries, endWithTheirBytes) {
  const Bytes profile = portrait().icc;
  EXPECT_EQ(files::primariesOfIcc(profile), v1::COLOR_PRIMARIES_DISPLAY_P3);
  for (size_t length = 0; length + 4 < profile.size(); ++length) {
    EXPECT_FALSE(files::primariesOfIcc(std::span(profile).first(length))) << length;
  }
  Bytes many = profile;
  many[128] = many[129] = 0xFF;  // four thousand million tags
  EXPECT_EQ(files::primariesOfIcc(many), v1::COLOR_PRIMARIES_DISPLAY_P3);
  many[132] = 'x';
  EXPECT_FALSE(files::primariesOfIcc(many));
}

}  // namespace
}  // namespace viewloom::test::photo_metadata_test
