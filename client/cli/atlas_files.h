// SPDX-License-Identifier: Apache-2.0
// Writes atlases as files: whole ones only, named by stream, frame and quilt suffix.
#pragma once

#include <filesystem>
#include <string>

#include "base/status.h"
#include "lib/atlas.h"

namespace viewloom::cli {

struct AtlasFileOptions {
  std::filesystem::path folder;
  std::string stream;
  bool writes_views = false;  // each view on its own instead of the atlas
  bool writes_png = false;    // instead of JPEG
};

// <stream>_<frame>_<sequence><suffix>.jpg, or <stream>_<frame>_<sequence>_view<index>.jpg; masks
// end in _mask.png. JPEG atlases are the server's bytes, untouched; views are encoded anew. Those
// of colour with depth end in _rgbd; of 16 bits they are one PNG of 16 bits, depth to the right of
// colour.
absl::Status writeAtlas(const Atlas& atlas, const AtlasFileOptions& options);

}  // namespace viewloom::cli
