// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/str_cat.h"
#include "fuzz/seeds.h"
#include "support/deep_exr_writer.h"
#include "unit/client/written_pictures.h"
#include "unit/photos/written_photo.h"

namespace viewloom {
namespace {

using Bytes = std::vector<uint8_t>;

Bytes bytesOf(const std::string& text) {
  return {text.begin(), text.end()};
}

// Two pixels, of one sample and of two.
Bytes deepExr(const test::DeepFileOptions& options) {
  const Imath::Box2i window({0, 0}, {1, 0});
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / strCat("viewloom-seed-", getpid(), ".exr");
  test::writeDeepExr(path, {.data = window, .display = window, .pixels = {{{}}, {{}, {}}}},
                     options);
  std::ifstream file(path, std::ios::binary);
  Bytes bytes(std::istreambuf_iterator<char>(file), {});
  std::filesystem::remove(path);
  return bytes;
}

}  // namespace

SeedBytes pictureSeeds() {
  const std::string bmp_info("\x28\0\0\0\2\0\0\0\1\0\0\0\1\0\x18\0", 16);
  return {bytesOf("Pf\n# two\n2 1\n-1\n12345678"),
          bytesOf("P2 2 1 9 1 2"),
          bytesOf("P6 1 1 255\nabc"),
          bytesOf(files::writtenNpy("<u2", "(1, 2)", "abcd")),
          bytesOf(files::rawBytes<float>({202021.25F}) + files::rawBytes<int32_t>({1, 1}) + "abcd"),
          bytesOf(std::string("BM\x3e\0\0\0\0\0\0\0\x36\0\0\0", 14) + bmp_info +
                  std::string(24, '\0') + "abcdef" + std::string(2, '\0'))};
}

SeedBytes metadataSeeds() {
  const std::string depth_map =
      "<x:xmpmeta><rdf:Description xmlns:GDepth=\"http://ns.google.com/photos/1.0/depthmap/\" "
      "GDepth:Format=\"RangeInverse\" GDepth:Near=\"0.5\" GDepth:Far=\"9\" "
      "GDepth:Data=\"iVBORw0K\"/></x:xmpmeta>";
  return {
      bytesOf(files::writtenJpeg(8, 8, Bytes(192, 99), files::exifOrientation(6))),
      bytesOf(files::exifOrientation(8)), bytesOf(depth_map),
      bytesOf(test::appleXmp("disparity", "0.25", "1.525")),
      test::iccProfile({{{0.436, 0.222, 0.014}, {0.385, 0.717, 0.097}, {0.143, 0.061, 0.714}}})};
}

SeedBytes exrSeeds() {
  return {deepExr({}), deepExr({.compression = Imf::RLE_COMPRESSION, .has_back = false}),
          deepExr({.compression = Imf::NO_COMPRESSION, .tile_side_px = 16})};
}

}  // namespace viewloom
