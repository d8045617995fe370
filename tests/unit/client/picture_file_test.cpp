// SPDX-License-Identifier: Apache-2.0
// Containers of pictures, against the samples that they were written with.
#include "files/picture_file.h"

#include <Imath/half.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <tiffio.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "unit/client/test_files.h"
#include "unit/client/written_pictures.h"

namespace viewloom::files::picture_file_test {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

class PictureFileTest : public ::testing::Test {
 protected:
  Picture read(const std::string& name, const std::string& bytes,
               PictureUse use = PictureUse::kDepth) const {
    auto picture = readPicture(folder_.write(name, bytes), use);
    EXPECT_TRUE(picture.ok()) << picture.status();
    return picture.ok() ? *std::move(picture) : Picture{};
  }
  std::string refusal(const std::string& name, const std::string& bytes) const {
    return std::string(
        readPicture(folder_.write(name, bytes), PictureUse::kDepth).status().message());
  }
  std::string tiff(const WrittenTiff& how, const std::string& samples) const {
    return writtenTiff((folder_.path() / "written.tif").string(), how, samples);
  }
  // No prefix of a file that is whole may pass, and each is refused by name.
  void expectEveryTruncationRefused(const std::string& name, const std::string& bytes,
                                    size_t slack = 0) const {
    for (size_t count = 0; count + slack < bytes.size(); ++count) {
      ASSERT_THAT(refusal(name, bytes.substr(0, count)), HasSubstr(name)) << count;
    }
  }

  const TestFolder folder_;
};

std::vector<float> samplesOf(const Picture& picture) {
  std::vector<float> samples;
  for (size_t i = 0; i < picture.pixelCount() * picture.channels; ++i) {
    samples.push_back(picture.sampleAt(i));
  }
  return samples;
}

std::string swapped(std::string bytes, size_t sample_bytes) {
  for (size_t at = 0; at + sample_bytes <= bytes.size(); at += sample_bytes) {
    std::reverse(bytes.begin() + long(at), bytes.begin() + long(at + sample_bytes));
  }
  return bytes;
}

TEST_F(PictureFileTest, readsNumpyArraysOfEveryNumberType) {
  const auto expectSix = [&](const std::string& type, const std::string& samples) {
    EXPECT_THAT(samplesOf(read("a.npy", writtenNpy(type, "(2, 3)", samples))),
                ElementsAre(1, 2, 3, 4, 5, 60))
        << type;
  };
  expectSix("|u1", rawBytes<uint8_t>({1, 2, 3, 4, 5, 60}));
  expectSix("<u2", rawBytes<uint16_t>({1, 2, 3, 4, 5, 60}));
  expectSix(">u2", swapped(rawBytes<uint16_t>({1, 2, 3, 4, 5, 60}), 2));
  expectSix("<u4", rawBytes<uint32_t>({1, 2, 3, 4, 5, 60}));
  expectSix("<i8", rawBytes<int64_t>({1, 2, 3, 4, 5, 60}));
  expectSix("<f4", rawBytes<float>({1, 2, 3, 4, 5, 60}));
  expectSix(">f4", swapped(rawBytes<float>({1, 2, 3, 4, 5, 60}), 4));
  expectSix("<f8", rawBytes<double>({1, 2, 3, 4, 5, 60}));
  std::string halves;
  for (const float value : {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 60.0F}) {
    halves += rawBytes({Imath::half(value).bits()});
  }
  expectSix("<f2", halves);
  EXPECT_THAT(samplesOf(read("a.npy", writtenNpy("<i2", "(1, 2)", rawBytes<int16_t>({-7, 9})))),
              ElementsAre(-7, 9));
}

TEST_F(PictureFileTest, readsNumpyArraysOfEveryShapeOrderAndVersion) {
  const std::string six = rawBytes<uint8_t>({1, 2, 3, 4, 5, 6});
  for (const char* shape : {"(2, 3)", "(2, 3, 1)", "(1, 2, 3, 1)", "(1, 1, 2, 3, 1)"}) {
    const Picture picture = read("a.npy", writtenNpy("|u1", shape, six));
    EXPECT_EQ(picture.width_px, 3U) << shape;
    EXPECT_EQ(picture.height_px, 2U) << shape;
    EXPECT_THAT(samplesOf(picture), ElementsAre(1, 2, 3, 4, 5, 6)) << shape;
  }
  for (const int version : {2, 3}) {
    EXPECT_EQ(read("a.npy", writtenNpy("|u1", "(2, 3)", six, false, version)).width_px, 3U);
  }
  EXPECT_THAT(samplesOf(read("a.npy", writtenNpy("|u1", "(2, 3)", six, true))),
              ElementsAre(1, 3, 5, 2, 4, 6));
  // Channels first, as torch has them: 3 x 1 x 5.
  std::string planes;
  for (uint8_t i = 0; i < 15; ++i) planes += static_cast<char>(i);
  const Picture color = read("a.npy", writtenNpy("|u1", "(3, 1, 5)", planes), PictureUse::kColor);
  EXPECT_EQ(color.channels, 3U);
  EXPECT_EQ(color.width_px, 5U);
  EXPECT_THAT(samplesOf(color), ElementsAre(0, 5, 10, 1, 6, 11, 2, 7, 12, 3, 8, 13, 4, 9, 14));
  EXPECT_THAT(refusal("a.npy", writtenNpy("<c8", "(2, 3)", six)), HasSubstr("holds '<c8'"));
  EXPECT_THAT(refusal("a.npy", writtenNpy("|u1", "(6,)", six)), HasSubstr("shape (6,"));
  EXPECT_THAT(refusal("a.npy", writtenNpy("|u1", "(9000, 9000)", six)), HasSubstr("1..8192"));
  expectEveryTruncationRefused("a.npy", writtenNpy("|u1", "(2, 3)", six));
}

TEST_F(PictureFileTest, readsPnmAsTextAndBinaryWithComments) {
  EXPECT_THAT(samplesOf(read("a.pgm", "P2 # grey\n2 1\n# most\n700\n5 700\n")),
              ElementsAre(5, 700));
  EXPECT_THAT(samplesOf(read("a.pgm", std::string("P5\n2 1\n65535\n\x01\x02\xff\xff", 17))),
              ElementsAre(258, 65535));
  EXPECT_THAT(samplesOf(read("a.ppm", "P6 2 1 255\nabcdef", PictureUse::kColor)),
              ElementsAre('a', 'b', 'c', 'd', 'e', 'f'));
  EXPECT_THAT(samplesOf(read("a.ppm", "P3 1 1 9 1 2 3", PictureUse::kColor)), ElementsAre(1, 2, 3));
  EXPECT_EQ(read("a.pgm", "P2 1 1 1000 7").whiteCode(), 1000U);
  EXPECT_THAT(refusal("a.pgm", "P2 1 1 255 256"), HasSubstr("is damaged (PNM"));
  EXPECT_THAT(refusal("a.pgm", "P5 2 2 255\nabc"), HasSubstr("ends before its picture is whole"));
  EXPECT_THAT(refusal("a.pgm", "P5 99999 2 255\nabc"), HasSubstr("1..8192"));
  EXPECT_THAT(refusal("a.pgm", "P4 8 1 a"), HasSubstr("accepted are P2, P3, P5 and P6"));
}

TEST_F(PictureFileTest, readsDptAndTellsItFromFlow) {
  const std::string head = rawBytes<float>({202021.25F}) + rawBytes<int32_t>({2, 1});
  EXPECT_THAT(samplesOf(read("a.dpt", head + rawBytes<float>({1.5F, 4}))), ElementsAre(1.5F, 4));
  EXPECT_THAT(refusal("a.dpt", head + rawBytes<float>({1, 2, 3, 4})), HasSubstr("optical flow"));
  expectEveryTruncationRefused("a.dpt", head + rawBytes<float>({1.5F, 4}));
}

TEST_F(PictureFileTest, readsBitmapsOfBothRowOrders) {
  // Two px wide, two high; rows are padded to four bytes.
  const auto bitmap = [](int32_t height) {
    const std::string info = rawBytes<uint32_t>({40}) + rawBytes<int32_t>({2, height}) +
                             rawBytes<uint16_t>({1, 24}) + rawBytes<uint32_t>({0, 0, 0, 0, 0, 0});
    const std::string rows("\x03\x02\x01\x06\x05\x04\0\0\x09\x08\x07\x0c\x0b\x0a\0\0", 16);
    return "BM" + rawBytes<uint32_t>({70, 0, 54}) + info + rows;
  };
  EXPECT_THAT(samplesOf(read("a.bmp", bitmap(-2), PictureUse::kColor)),
              ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12));
  EXPECT_THAT(samplesOf(read("a.bmp", bitmap(2), PictureUse::kColor)),
              ElementsAre(7, 8, 9, 10, 11, 12, 1, 2, 3, 4, 5, 6));
  expectEveryTruncationRefused("a.bmp", bitmap(2));
}

TEST_F(PictureFileTest, readsTiffOfManyLayouts) {
  const std::string codes = rawBytes<uint16_t>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 65535});
  const WrittenTiff grey{.width_px = 4, .height_px = 3, .bits = 16};
  std::vector<WrittenTiff> ways(7, grey);
  ways[1].mode = "wb";
  ways[2].mode = "w8";
  ways[3].compression = COMPRESSION_LZW;
  ways[4].compression = COMPRESSION_ADOBE_DEFLATE;
  ways[4].predictor = PREDICTOR_HORIZONTAL;
  ways[5].tile_px = 16;
  ways[6].compression = COMPRESSION_PACKBITS;
  for (const WrittenTiff& how : ways) {
    EXPECT_THAT(samplesOf(read("a.tif", tiff(how, codes))),
                ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 65535))
        << how.mode << how.compression << how.tile_px;
  }
  WrittenTiff white = grey;
  white.photometric = PHOTOMETRIC_MINISWHITE;
  EXPECT_EQ(samplesOf(read("a.tif", tiff(white, codes))).back(), 0);
  WrittenTiff floats{.width_px = 2, .height_px = 1, .bits = 32, .format = SAMPLEFORMAT_IEEEFP};
  floats.compression = COMPRESSION_ADOBE_DEFLATE;
  floats.predictor = PREDICTOR_FLOATINGPOINT;
  EXPECT_THAT(samplesOf(read("a.tif", tiff(floats, rawBytes<float>({0.25F, 9})))),
              ElementsAre(0.25F, 9));
  WrittenTiff whole{.width_px = 2, .height_px = 1, .bits = 32};
  EXPECT_THAT(samplesOf(read("a.tif", tiff(whole, rawBytes<uint32_t>({70000, 3})))),
              ElementsAre(70000, 3));
  WrittenTiff apart{.width_px = 2, .height_px = 1, .channels = 3, .bits = 8};
  apart.photometric = PHOTOMETRIC_RGB;
  for (const int planar : {PLANARCONFIG_CONTIG, PLANARCONFIG_SEPARATE}) {
    apart.planar = static_cast<uint16_t>(planar);
    EXPECT_THAT(samplesOf(read("a.tif", tiff(apart, "abcdef"), PictureUse::kColor)),
                ElementsAre('a', 'b', 'c', 'd', 'e', 'f'));
  }
  const std::string written = tiff(grey, codes);
  for (size_t count = 0; count < written.size(); count += 3) {
    ASSERT_NE(refusal("a.tif", written.substr(0, count)), "") << count;
  }
}

// Four px, all different: 2 wide, 2 high as stored.
const std::vector<uint8_t> kFourPx{10, 10, 10, 90, 90, 90, 170, 170, 170, 250, 250, 250};

// The four pixels a b / c d in each of Exif's orientations.
TEST_F(PictureFileTest, turnsByEveryOrientationInEveryContainer) {
  const uint8_t a = 10, b = 90, c = 170, d = 250;
  const std::vector<std::vector<uint8_t>> shown{{a, b, c, d}, {b, a, d, c}, {d, c, b, a},
                                                {c, d, a, b}, {a, c, b, d}, {c, a, d, b},
                                                {d, b, c, a}, {b, d, a, c}};
  std::vector<uint8_t> blocks;  // of 8x8 px, so that JPEG leaves them apart
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const uint8_t code = kFourPx[size_t(3 * (y / 8 * 2 + x / 8))];
      blocks.insert(blocks.end(), {code, code, code});
    }
  }
  for (uint16_t orientation = 1; orientation <= 8; ++orientation) {
    const std::string exif = exifOrientation(orientation);
    WrittenTiff how{.width_px = 16, .height_px = 16, .channels = 3, .bits = 8};
    how.photometric = PHOTOMETRIC_RGB;
    how.orientation = orientation;
    const std::string samples(blocks.begin(), blocks.end());
    const std::pair<std::string, std::string> files[] = {
        {"a.jpg", writtenJpeg(16, 16, blocks, exif)},
        {"a.png", writtenPng(16, 16, PNG_COLOR_TYPE_RGB, 8, blocks, {.exif = exif})},
        {"a.webp", writtenWebp(16, 16, blocks, exif)},
        {"a.tif", tiff(how, samples)}};
    for (const auto& [name, bytes] : files) {
      const Picture picture = read(name, bytes, PictureUse::kColor);
      for (size_t i = 0; i < 4; ++i) {
        const size_t pixel = (i / 2 * 8 + 4) * 16 + i % 2 * 8 + 4;
        EXPECT_NEAR(picture.sampleAt(3 * pixel), shown[orientation - 1U][i], 3)
            << name << " orientation " << orientation << " px " << i;
      }
    }
  }
}

TEST_F(PictureFileTest, exchangesSidesOfPicturesThatLieOnTheirSide) {
  const Picture picture = read(
      "a.png", writtenPng(3, 1, PNG_COLOR_TYPE_GRAY, 8, {1, 2, 3}, {.exif = exifOrientation(6)}));
  EXPECT_EQ(picture.width_px, 1U);
  EXPECT_EQ(picture.height_px, 3U);
  EXPECT_THAT(samplesOf(picture), ElementsAre(1, 2, 3));
}

TEST_F(PictureFileTest, honoursWhatPngSaysOfColourInItsOrder) {
  const auto plane = [&](int bits, const PngChunks& chunks) {
    const std::vector<uint8_t> grey = bits == 8 ? std::vector<uint8_t>{128, 128, 128}
                                                : std::vector<uint8_t>{0x80, 0, 0x80, 0, 0x80, 0};
    return colorPlane(
        read("a.png", writtenPng(1, 1, PNG_COLOR_TYPE_RGB, bits, grey, chunks), PictureUse::kColor),
        v1::COLOR_TRANSFER_UNSPECIFIED);
  };
  EXPECT_EQ(plane(8, {}).transfer, v1::COLOR_TRANSFER_UNSPECIFIED);
  EXPECT_EQ(plane(8, {.gamma = 1}).transfer, v1::COLOR_TRANSFER_LINEAR);
  EXPECT_EQ(plane(8, {.gamma = 0.45455}).transfer, v1::COLOR_TRANSFER_UNSPECIFIED);
  EXPECT_EQ(plane(8, {.gamma = 1, .has_srgb = true}).transfer, v1::COLOR_TRANSFER_UNSPECIFIED);
  // 128 / 255 to the power of 1.8 is 0.289 of light, 146.4 of 255 in sRGB.
  EXPECT_NEAR(plane(8, {.gamma = 1 / 1.8}).bytes[0], 146.4, 1);
  const auto lightOf = [](const PlaneImage& image) {
    uint16_t bits = 0;
    std::memcpy(&bits, image.bytes.data(), 2);
    return float{Imath::half(Imath::half::FromBits, bits)};
  };
  EXPECT_NEAR(lightOf(plane(16, {})), 0.2140, 2e-4);
  EXPECT_NEAR(lightOf(plane(16, {.gamma = 1})), 0.5, 5e-4);
  EXPECT_NEAR(lightOf(plane(16, {.gamma = 0.5})), 0.25, 3e-4);
  EXPECT_TRUE(plane(8, {.has_p3_chrm = true}).chromaticities.has_value());
  EXPECT_FALSE(plane(8, {.has_srgb = true, .has_p3_chrm = true}).chromaticities.has_value());
}

TEST_F(PictureFileTest, readsWebpAsWritten) {
  EXPECT_THAT(read("a.webp", writtenWebp(2, 2, kFourPx), PictureUse::kColor).bytes,
              ElementsAreArray(kFourPx));
  expectEveryTruncationRefused("a.webp", writtenWebp(2, 2, kFourPx), 2);
}

TEST_F(PictureFileTest, tellsContainersByContentWhateverTheName) {
  EXPECT_EQ(read("a.jpg", writtenPng(1, 1, PNG_COLOR_TYPE_GRAY, 8, {77})).sampleAt(0), 77);
  EXPECT_EQ(read("noext", "P2 1 1 255 9").sampleAt(0), 9);
  EXPECT_EQ(read("A.NPY", writtenNpy("|u1", "(1, 1)", "a")).sampleAt(0), 'a');
}

}  // namespace
}  // namespace viewloom::files::picture_file_test
