// SPDX-License-Identifier: Apache-2.0
#include "fuzz/seeds.h"

#include <cstddef>
#include <string>

#include "unit/client/written_pictures.h"
#include "unit/decode/jpeg_samples.h"
#include "unit/decode/predicted_samples.h"
#include "unit/decode/zstd_samples.h"

namespace viewloom {
namespace {

using Bytes = std::vector<uint8_t>;

Bytes joined(Bytes front, const Bytes& back) {
  front.insert(front.end(), back.begin(), back.end());
  return front;
}

}  // namespace

SeedBytes jpegSeeds() {
  SeedBytes seeds;
  for (const JpegSort sort : {JpegSort::kBaseline, JpegSort::kGrey}) {
    seeds.push_back(joined({40, 24}, sampleJpeg({40, 24}, sort)));
  }
  return seeds;
}

SeedBytes zstdSeeds() {
  Bytes content(601);
  for (size_t i = 0; i < content.size(); ++i) content[i] = static_cast<uint8_t>(i * i / 5);
  const Bytes expected{600 >> 8, 600 & 255};  // one less than the content
  return {joined(expected, zstdFrame(content, ZstdSize::kStated)),
          joined(expected, zstdFrame(content, ZstdSize::kOpen))};
}

SeedBytes predictedSeeds() {
  std::vector<uint16_t> samples(20 * 10);
  for (size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<uint16_t>(i * i * 9);
  const Bytes content = predictedBytes(samples, 20, 10);
  return {joined({19, 9}, zstdFrame(content, ZstdSize::kStated)),
          joined({19, 9}, zstdFrame(content, ZstdSize::kOpen))};
}

SeedBytes frameSeeds() {
  // Number, focal length, layers; depth first; RGB8 3x2, no option; U16 3x2; then 12 and 18 bytes.
  const Bytes header{1, 9, 1, 1, 1, 3, 2, 0, 0, 1, 2, 6, 3, 2, 0, 0, 1, 2};
  const Bytes depth = joined({12}, Bytes(12, 1));
  const Bytes color = joined({18}, Bytes(18, 2));
  // The same with depth predicted, of as many bytes as are declared in four more.
  const Bytes packed = zstdFrame(predictedBytes({1, 2, 3, 4, 5, 6}, 3, 2), ZstdSize::kStated);
  const auto packed_bytes = static_cast<uint8_t>(packed.size());
  const Bytes predicted_header{1, 9, 1, 1,  1, 3, 2, 0, 0, 1, 2,
                               6, 3, 2, 24, 0, 1, 2, 0, 0, 0, packed_bytes};
  const Bytes predicted = joined({packed_bytes}, packed);
  return {joined(header, joined(depth, color)), joined(predicted_header, joined(predicted, color))};
}

SeedBytes pictureSeeds() {
  const auto bytesOf = [](const std::string& text) { return Bytes(text.begin(), text.end()); };
  const std::string bmp_info("\x28\0\0\0\2\0\0\0\1\0\0\0\1\0\x18\0", 16);
  return {bytesOf("Pf\n# two\n2 1\n-1\n12345678"),
          bytesOf("P2 2 1 9 1 2"),
          bytesOf("P6 1 1 255\nabc"),
          bytesOf(files::writtenNpy("<u2", "(1, 2)", "abcd")),
          bytesOf(files::rawBytes<float>({202021.25F}) + files::rawBytes<int32_t>({1, 1}) + "abcd"),
          bytesOf(std::string("BM\x3e\0\0\0\0\0\0\0\x36\0\0\0", 14) + bmp_info +
                  std::string(24, '\0') + "abcdef" + std::string(2, '\0')),
          bytesOf(files::writtenJpeg(8, 8, Bytes(192, 99), files::exifOrientation(6)))};
}

}  // namespace viewloom
