// SPDX-License-Identifier: Apache-2.0
// Contents of an OpenEXR file's header: its parts, their channels, camera and colour.
#pragma once

#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfForward.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/status.h"
#include "files/exr_header.h"

namespace viewloom::files {

struct ExrDescribedChannel {
  // By which readExrColor and readExrDepth find it: with the part's name before it where the file
  // has several parts and the channel does not carry it already.
  std::string name;
  std::string type;  // "half", "float", "uint"
  bool is_subsampled = false;
};

struct ExrDescribedPart {
  std::string name;      // "" = none
  std::string view;      // "" = none, or in the names of the channels
  std::string type;      // "scanlineimage", "tiledimage", "deepscanline", "deeptile"
  int64_t width_px = 0;  // of the display window
  int64_t height_px = 0;
  ExrWindow data;
  ExrWindow display;
  std::vector<ExrDescribedChannel> channels;

  bool isDeep() const { return type.starts_with("deep"); }
};

// Directions that the px of an environment map see; kNone = a picture of a pinhole.
enum class ExrEnvmap { kNone, kLatLong, kCube };

// Matrix as in the file, unchecked: 16 numbers in the order in which vectors are rows.
using ExrMatrix = std::array<double, 16>;

struct ExrDescription {
  std::vector<ExrDescribedPart> parts;
  std::vector<std::string> views;
  // Attributes of the first part by name: texts, and numbers as text.
  std::map<std::string, std::string> texts;
  std::optional<ExrMatrix> world_to_camera;
  std::optional<ExrMatrix> world_to_ndc;
  std::optional<Imf::Chromaticities> chromaticities;
  double pixel_aspect = 1;  // width of a px divided by its height
  ExrEnvmap envmap = ExrEnvmap::kNone;

  bool isDeep() const;
};

// All channels, for messages: "R, G, B, left.R".
std::string listExrChannels(const ExrDescription& description);

absl::StatusOr<ExrDescription> describeExr(const std::filesystem::path& path);
// May throw what OpenEXR throws.
ExrDescription describeExr(const Imf::MultiPartInputFile& file);

}  // namespace viewloom::files
