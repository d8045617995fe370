// SPDX-License-Identifier: Apache-2.0
// Cameras of MPEG's test model for immersive video (TMIV), from their JSON.
#pragma once

#include <filesystem>
#include <string>

#include "base/status.h"
#include "viewloom/v1/frame.pb.h"
#include "viewloom/v1/manifest.pb.h"

namespace viewloom::inputs {

struct TmivCamera {
  std::string name;
  v1::Camera camera;
  v1::SizePx size;
  v1::DepthFormat depth;  // of whole numbers up to 2^depth_bits - 1
  uint32_t color_bits = 10;
  uint32_t depth_bits = 16;
  bool color_has_chroma = true;
  bool depth_has_chroma = true;
};

// `name` picks one of the file's cameras; "" = the one whose name begins the name of `depth_file`,
// or the only one. Perspective cameras alone are accepted. TMIV's world is right-handed with x
// forward, y left and z up; yaw about z comes last, roll about x first; it becomes x right, y up
// and -z forward. Errors name the file and the key.
absl::StatusOr<TmivCamera> readTmivCamera(const std::filesystem::path& path,
                                          const std::string& name, const std::string& depth_file);

}  // namespace viewloom::inputs
