// SPDX-License-Identifier: Apache-2.0
// Writes atlases as files: whole ones only, named by stream, frame and quilt suffix, always new.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/status.h"
#include "lib/atlas.h"
#include "lib/color_decoder.h"

namespace viewloom::cli {

struct AtlasFileOptions {
  std::filesystem::path folder;
  std::string stream;
  bool writes_views = false;  // each view on its own instead of the atlas
  bool writes_png = false;    // instead of JPEG
};

// Files are named <stream>_<frame>_<sequence><suffix>.jpg, or
// <stream>_<frame>_<sequence>_view<index> .jpg; masks end in _mask.png. JPEG atlases are the
// server's bytes, untouched; views are encoded anew. Those of colour with depth end in _rgbd; of 16
// bits they are one PNG of 16 bits, depth to the right of colour. No file is ever replaced: where
// the folder has files of the stream, and when the server counts anew, names begin with
// <stream>_r2, <stream>_r3 and so on. Thread-safety: none; one owner.
class AtlasFiles {
 public:
  explicit AtlasFiles(AtlasFileOptions options);

  // The first and the number of the files written. Fails when a file cannot be written, and when
  // the server's suffix is no part of a file name.
  struct Written {
    std::filesystem::path first;
    uint32_t count = 0;
  };
  absl::StatusOr<Written> write(const Atlas& atlas);

 private:
  std::filesystem::path stemOf(const v1::AtlasHeader& header) const;

  const AtlasFileOptions options_;
  ColorDecoder decoder_;
  const std::string name_;  // the stream's, fit for files
  uint64_t run_ = 1;
  uint64_t last_sequence_ = 0;
};

// Makes the folder where there is none; INVALID_ARGUMENT when it takes no new files. "" = none.
absl::Status makeAtlasFolder(const std::filesystem::path& folder);

// "quilts/demo_000001_000001_qs8x6a0.75.jpg", and how many more there are.
std::string describe(const AtlasFiles::Written& written);

}  // namespace viewloom::cli
