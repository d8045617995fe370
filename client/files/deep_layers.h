// SPDX-License-Identifier: Apache-2.0
// A deep EXR file as the layers of a source.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/status.h"
#include "files/plane_file.h"
#include "viewloom/v1/manifest.pb.h"

namespace viewloom::files {

// Cost of splitting a deep file into layers. Shares and means are over the pixels with samples.
struct DeepReport {
  std::string file;
  uint32_t layer_count = 0;
  uint64_t sample_count = 0;          // in view
  uint64_t dropped_sample_count = 0;  // of those, without a place in front of the camera
  uint32_t samples_per_px_max = 0;
  uint64_t pixel_count = 0;         // with samples
  uint64_t merged_pixel_count = 0;  // with surfaces at more depths than there are layers
  double error_mean_per_m = 0;      // occlusion error (deep/split_pixel.h), 1/m
  double error_max_per_m = 0;

  double mergedShare() const;
};

struct DeepLayers {
  // The colour of each layer and its depth, in turn, nearest layer first: RGBA16F, linear and
  // premultiplied, and DEPTH_F32 in metres, 0 where the layer has no surface.
  std::vector<LoadedPlane> planes;
  DeepReport report;
};

// Errors name the field of the DeepFile, and the file. Relative file names are taken from `folder`.
absl::StatusOr<DeepLayers> loadDeepLayers(const v1::DeepFile& file,
                                          const std::filesystem::path& folder);

}  // namespace viewloom::files
