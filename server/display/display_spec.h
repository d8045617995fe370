// SPDX-License-Identifier: Apache-2.0
// What a client wants to see, checked and with every default filled in but those the stream gives.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/status.h"
#include "frame/camera.h"

namespace viewloom {

enum class TileOrder : uint8_t { kBottomLeft, kTopLeft };
enum class StereoLayout : uint8_t { kSideBySide, kTopBottom };
enum class OutsideFill : uint8_t { kBorder, kBackground };

// A camera given by angles or by intrinsics in tile px.
struct ViewCamera {
  Pose pose;  // relative to the display
  std::variant<Fov, Intrinsics> projection;
};

// Off-axis views from a line. What is 0 comes from the stream or the preset (proto QuiltDisplay).
struct QuiltSpec {
  std::string preset;  // the name it came from, for the catalogue; "" = none
  uint32_t columns = 0;
  uint32_t rows = 0;
  SizePx size_px;
  double aspect = 0;           // 0 = that of a tile
  double view_cone_rad = 0;
  double focal_distance_m = 0;  // 0 = from the stream
  double fov_y_rad = 0;         // 0 = what the source sees
  TileOrder order = TileOrder::kBottomLeft;
  uint32_t view_count = 0;
};

struct StereoSpec {
  StereoLayout layout = StereoLayout::kSideBySide;
  SizePx eye_size_px;
  double eye_distance_m = 0;    // 0 = 0.063
  double focal_distance_m = 0;  // 0 = from the stream
  double fov_y_rad = 0;         // 0 = what the source sees
  std::vector<ViewCamera> eyes;  // none or two
};

struct CamerasSpec {
  std::vector<ViewCamera> cameras;
  SizePx tile_size_px;
  uint32_t columns = 0;
  TileOrder order = TileOrder::kTopLeft;
};

struct DisplaySpec {
  std::variant<QuiltSpec, StereoSpec, CamerasSpec> kind;
  std::optional<Pose> world_pose;  // none = stands in the source's camera
  double tolerance_px = 0;         // output px; 0 = 0.25
  OutsideFill outside_fill = OutsideFill::kBorder;
  uint32_t background_rgb = 0;  // 0xRRGGBB, sRGB
};

// Ranges of proto Display. Focal distances are held far inside what binary64 squares without loss.
inline constexpr uint32_t kQuiltGridMax = 50;
inline constexpr uint32_t kQuiltSidePxMax = 16384;
inline constexpr uint32_t kEyeSidePxMax = 8192;
inline constexpr uint32_t kCameraCountMax = 1024;
inline constexpr double kAspectMin = 0.05;
inline constexpr double kAspectMax = 20;
inline constexpr double kViewAngleMax_rad = 2.6;  // of a cone or a field of view; tan(1.3) = 3.6
inline constexpr double kFocalDistanceMin_m = 1e-6;
inline constexpr double kFocalDistanceMax_m = 1e9;
inline constexpr double kEyeDistanceMax_m = 10;
inline constexpr double kTolerancePxMax = 16;
inline constexpr uint32_t kJpegSidePxMax = 65500;  // libjpeg's JPEG_MAX_DIMENSION
inline constexpr double kDefaultViewCone_rad = 0.69813170079773183;  // 40 deg
inline constexpr double kDefaultEyeDistance_m = 0.063;
inline constexpr double kDefaultTolerance_px = 0.25;

// Checks every range and fills in presets and defaults that need no stream. Errors name the field
// as in proto Display ("quilt.columns"). NOT_FOUND for a preset that does not exist.
absl::StatusOr<DisplaySpec> completeDisplaySpec(DisplaySpec spec);

enum class BandEncoding : uint8_t { kJpeg, kZstd, kRaw };
enum class Chroma : uint8_t { k420, k444 };

// How the atlas is packed.
struct EncodingSpec {
  BandEncoding color = BandEncoding::kJpeg;
  uint32_t jpeg_quality = 85;  // 1..100
  Chroma chroma = Chroma::k420;
  bool with_depth = false;
  bool with_mask = false;
  BandEncoding planes = BandEncoding::kZstd;  // kZstd or kRaw

  bool operator==(const EncodingSpec&) const = default;
};

// Errors name the field as in proto AtlasEncoding.
absl::Status validateEncodingSpec(const EncodingSpec& encoding);

// Expect completed specs. Same key = same picture from the same stream: traced once. What cannot
// change the picture (a preset's name, the JPEG quality of lossless colour) is left out.
std::string displayKey(const DisplaySpec& spec);
std::string encodingKey(const EncodingSpec& encoding);

}  // namespace viewloom
