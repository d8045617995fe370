// SPDX-License-Identifier: Apache-2.0
// Writes deep EXR files with OpenEXR's own interface, apart from the reader under test.
#pragma once

#include <Imath/ImathBox.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfPixelType.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "deep/deep_sample.h"

namespace viewloom::test {

using DeepPixel = std::vector<deep::DeepSample>;

struct DeepPicture {
  Imath::Box2i data;
  Imath::Box2i display;
  std::vector<DeepPixel> pixels;  // of the data window, row by row
};

struct DeepFileOptions {
  Imf::Compression compression = Imf::ZIPS_COMPRESSION;
  int tile_side_px = 0;  // 0 = scan lines
  bool has_mip_levels = false;
  bool has_back = true;
  bool is_second_part = false;  // behind a flat one
  // By channel; FLOAT where nothing is said. Further channels are written as zeros.
  std::map<std::string, Imf::PixelType> types;
  std::optional<Imf::Chromaticities> chromaticities;
};

// Throws when OpenEXR does.
void writeDeepExr(const std::filesystem::path& path, const DeepPicture& picture,
                  const DeepFileOptions& options);

}  // namespace viewloom::test
