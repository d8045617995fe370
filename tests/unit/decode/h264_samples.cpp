// SPDX-License-Identifier: Apache-2.0
#include "unit/decode/h264_samples.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/check.h"
#include "support/video/sample_picture.h"
#include "unit/decode/jpeg_samples.h"
#include "video/openh264_encoder.h"
#include "video/still_pictures.h"

namespace viewloom {
namespace {

// The colours of JPEG files. The picture is smooth: one pixel of four tells its chroma.
void putPixel(test::SamplePicture& picture, uint32_t x, uint32_t y, const uint8_t rgb[3]) {
  const double luma = 0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2];
  const auto code = [](double value) {
    return uint8_t(std::lround(std::clamp(value, 0.0, 255.0)));
  };
  picture.luma(x, y) = code(luma);
  picture.cb(x, y) = code(128 + (rgb[2] - luma) / 1.772);
  picture.cr(x, y) = code(128 + (rgb[0] - luma) / 1.402);
}

// Rows of the sample as a picture with even sides; edges are repeated.
test::SamplePicture rowsOfSample(SizePx whole_px, uint32_t first_row, SizePx size_px) {
  test::SamplePicture picture(size_px);
  for (uint32_t y = 0; y < size_px.height; ++y) {
    for (uint32_t x = 0; x < size_px.width; ++x) {
      uint8_t rgb[3];
      samplePixel(whole_px, std::min(x, whole_px.width - 1),
                  std::min(first_row + y, whole_px.height - 1), rgb);
      putPixel(picture, x, y, rgb);
    }
  }
  return picture;
}

std::vector<uint8_t> coded(VideoEncoder& encoder, const test::SamplePicture& picture,
                           Reference reference) {
  std::vector<uint8_t> bytes;
  VIEWLOOM_CHECK(encoder.encode(picture.video(), reference, bytes).ok());
  return bytes;
}

std::unique_ptr<OpenH264Encoder> encoderOf(SizePx size_px, const H264Sample& sample) {
  auto encoder = OpenH264Encoder::make(
      {.size_px = size_px, .qp = sample.qp, .thread_count = sample.slice_count});
  VIEWLOOM_CHECK(encoder.ok());
  return *std::move(encoder);
}

}  // namespace

std::vector<uint8_t> sampleH264(SizePx size_px, const H264Sample& sample) {
  const SizePx even_px = stillSize(size_px);
  std::vector<uint8_t> plane;
  for (uint32_t row = 0; row < even_px.height; row += sample.picture_rows) {
    const SizePx picture_px = {even_px.width, std::min(sample.picture_rows, even_px.height - row)};
    const std::vector<uint8_t> picture = coded(
        *encoderOf(picture_px, sample), rowsOfSample(size_px, row, picture_px), Reference::kNone);
    plane.insert(plane.end(), picture.begin(), picture.end());
  }
  return plane;
}

std::vector<uint8_t> dependentH264(SizePx size_px) {
  const SizePx even_px = stillSize(size_px);
  const auto encoder = encoderOf(even_px, {});
  const test::SamplePicture picture = rowsOfSample(size_px, 0, even_px);
  coded(*encoder, picture, Reference::kNone);
  return coded(*encoder, picture, Reference::kPictureBefore);
}

std::vector<uint8_t> bytesOfHex(std::string_view digits) {
  const auto value = [](char digit) { return digit <= '9' ? digit - '0' : digit - 'a' + 10; };
  std::vector<uint8_t> bytes;
  for (size_t i = 0; i + 1 < digits.size(); i += 2) {
    bytes.push_back(uint8_t(16 * value(digits[i]) + value(digits[i + 1])));
  }
  return bytes;
}

std::vector<uint8_t> x264Still() {
  return bytesOfHex(
      "000000016764100aacb92d80b702020640000003004000000f010000000168ee06f2c00000016588"
      "843fad3659a490ea31ea5884ba27575b5052d38f6825cb0571e0c51338df351baf2c38ba796a9ed6"
      "83d18d4edc4687b1b1c7782ecce34de0eaa0d8eb71f923ef12d01b34f08ceb51459860015e3a20e8"
      "6f04b4ad273ac07f2e380cff16da1f0916351360fe32c814b5c0b9759f781f4a047781c50bf14bff"
      "d47e0599bfc1");
}

std::vector<uint8_t> x264LimitedRange() {
  return bytesOfHex(
      "000000016764000aacd9496c0440000003004000000f03c48965800000000168ef86f2c000000165"
      "888400ffa7981e4c2687d07c068ed2ce277da3a6223619ee58f356cd886a3e6af1ec1a32741428a6"
      "e27a90b0c6451c43c83d46831d9d7a4fe9228cc1d22825bef62f545832ca4825204d234a0b3a44a8"
      "4667241f55a5c1f54d72e4f38b12116154d8ae02592c9fcec0a07506c44ba99c4371d3c6f232aa56"
      "3dafe9724d9ad86d170668dd4ce9ef5eaf00d12efd8356d7ce2ba9e0db2e93d2959a247df2eb17a0"
      "6bbee4bf");
}

std::vector<uint8_t> x264BPictures() {
  return bytesOfHex(
      "000000016764000aacd9496c05b8101032000003000200000300781e244b2c0000000168ebe112c8"
      "b000000165888400ffa2d531ffc248633dafc4bbd65e0536cd1a763aefd1c193585271bb52571367"
      "d373fb0ad0ee93cc887301af14aa8f9fcb7d9166f1cf1d9a229726f8f42c96ef7bffe10000000141"
      "9a236c7f7bf75c00000001419e4178afb48100000001019e626a49ffd242a0");
}

std::vector<uint8_t> x264FullChroma() {
  return bytesOfHex(
      "0000000167f4000a919b292d80b702020640000003004000000f03c48965800000000168ef844648"
      "6400000165888400ffe384d567ff845b7a06effc1ddd1ac67c755ea8255d20aecf6b18efe27bd913"
      "c4719e301c97565c822ed2f7d8d5398a30724399a39522f2cc398a2ace0ebbf6fd517d14be0ae9c6"
      "f03963a1");
}

}  // namespace viewloom
