// SPDX-License-Identifier: Apache-2.0
#include "files/netpbm_image.h"

#include <Imath/half.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "unit/client/test_files.h"

namespace viewloom::files::pfm_image_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string floats(std::initializer_list<float> values, bool little_endian) {
  std::string bytes;
  for (const float value : values) {
    const auto bits = std::bit_cast<uint32_t>(value);
    for (int i = 0; i < 4; ++i) {
      bytes += static_cast<char>(bits >> (8 * (little_endian ? i : 3 - i)));
    }
  }
  return bytes;
}

std::vector<float> samplesOf(const PlaneImage& image) {
  std::vector<float> samples(image.bytes.size() / 4);
  std::memcpy(samples.data(), image.bytes.data(), image.bytes.size());
  return samples;
}

std::string messageOf(const absl::StatusOr<PlaneImage>& image) {
  return image.ok() ? "OK" : std::string(image.status().message());
}

TEST(PfmImage, turnsTheBottomRowUp) {
  const TestFolder folder;
  const auto file = folder.write("a.pfm", "Pf\n2 3\n-1.0\n" + floats({5, 6, 3, 4, 1, 2}, true));
  const auto image = readPfmDepth(file);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->encoding, v1::PLANE_ENCODING_DEPTH_F32);
  EXPECT_THAT(samplesOf(*image), ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST(PfmImage, readsBothByteOrders) {
  const TestFolder folder;
  const auto big =
      readPfmDepth(folder.write("big.pfm", "Pf\n2 1\n1\n" + floats({1.5F, -2}, false)));
  ASSERT_TRUE(big.ok()) << big.status();
  EXPECT_THAT(samplesOf(*big), ElementsAre(1.5F, -2));
}

TEST(PfmImage, readsColourAsHalfWithOpaqueAlpha) {
  const TestFolder folder;
  const auto image =
      readPfmColor(folder.write("c.pfm", "PF 1 1 -1\n" + floats({0.25F, 2, 0}, true)));
  ASSERT_TRUE(image.ok()) << image.status();
  Imath::half rgba[4];
  ASSERT_EQ(image->bytes.size(), sizeof(rgba));
  std::memcpy(static_cast<void*>(rgba), image->bytes.data(), sizeof(rgba));
  EXPECT_THAT(rgba, ElementsAre(0.25F, 2.0F, 0.0F, 1.0F));
}

TEST(PfmImage, refusesWhatIsNoPfm) {
  const TestFolder folder;
  const std::string sample = floats({1}, true);
  EXPECT_THAT(messageOf(readPfmDepth(folder.write("x.pfm", "P6\n1 1\n-1\n" + sample))),
              HasSubstr("no PFM header"));
  EXPECT_THAT(messageOf(readPfmDepth(folder.write("x.pfm", ""))), HasSubstr("no PFM header"));
  EXPECT_THAT(messageOf(readPfmDepth(folder.write("x.pfm", "Pf\n1 1\n0\n" + sample))),
              HasSubstr("no PFM header"));
  EXPECT_THAT(messageOf(readPfmDepth(folder.write("x.pfm", "Pf\n1 1\nnan\n" + sample))),
              HasSubstr("no PFM header"));
}

TEST(PfmImage, refusesHostileSizesAndWrongLengths) {
  const TestFolder folder;
  const std::string sample = floats({1}, true);
  for (const char* size : {"0 1", "1 -1", "8193 1", "1 99999999999999"}) {
    EXPECT_THAT(messageOf(readPfmDepth(
                    folder.write("x.pfm", std::string("Pf\n") + size + "\n-1\n" + sample))),
                HasSubstr("accepted is 1..8192"));
  }
  EXPECT_THAT(messageOf(readPfmDepth(folder.write("x.pfm", "Pf\n1 1\n-1\n" + sample + "x"))),
              HasSubstr("1x1 px need"));
  EXPECT_THAT(messageOf(readPfmDepth(folder.write("x.pfm", "Pf\n2 1\n-1\n" + sample))),
              HasSubstr("ends before its picture is whole (PFM)"));
}

TEST(PfmImage, readsGreyAsColourAndGreyColourAsDepth) {
  const TestFolder folder;
  const auto grey = readPfmColor(folder.write("g.pfm", "Pf\n1 1\n-1\n" + floats({0.5F}, true)));
  ASSERT_TRUE(grey.ok()) << grey.status();
  Imath::half rgba[4];
  std::memcpy(static_cast<void*>(rgba), grey->bytes.data(), sizeof(rgba));
  EXPECT_THAT(rgba, ElementsAre(0.5F, 0.5F, 0.5F, 1.0F));
  const auto depth =
      readPfmDepth(folder.write("c.pfm", "PF 2 1 -1\n" + floats({4, 4, 4, 2, 2, 2}, true)));
  ASSERT_TRUE(depth.ok()) << depth.status();
  EXPECT_THAT(samplesOf(*depth), ElementsAre(4, 2));
  EXPECT_THAT(
      messageOf(readPfmDepth(folder.write("c.pfm", "PF 1 1 -1\n" + floats({4, 1, 0}, true)))),
      HasSubstr("is coloured"));
  EXPECT_EQ(readPfmColor(folder.path() / "none.pfm").status().code(), absl::StatusCode::kNotFound);
}

TEST(PfmImage, readsCommentsAndEveryWhiteSpaceOfHeaders) {
  const TestFolder folder;
  // A first sample whose lowest byte is a line feed: the file's length tells what ends the header.
  const std::string samples = floats({std::bit_cast<float>(0x3F80000AU), 7}, true);
  for (const char* header : {"Pf\r\n2 1\r\n-1.0\r\n", "Pf\n# made by hand\n2\n1\n-1.000000\n",
                             "Pf  2\t1   -1 \n", "Pf\r2 1\r-1\r"}) {
    const auto image = readPfmDepth(folder.write("w.pfm", header + samples));
    ASSERT_TRUE(image.ok()) << image.status() << header;
    EXPECT_THAT(samplesOf(*image), ElementsAre(std::bit_cast<float>(0x3F80000AU), 7)) << header;
  }
}

}  // namespace
}  // namespace viewloom::files::pfm_image_test
