// SPDX-License-Identifier: Apache-2.0
// What a client wants to see, checked and with every default filled in but those the stream gives.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "base/status.h"
#include "display/display_kinds.h"
#include "display/lens.h"
#include "display/ray_samples.h"
#include "display/reflection.h"
#include "display/temporal_spec.h"
#include "frame/camera.h"

namespace viewloom {

enum class OutsideFill : uint8_t { kBorder, kBackground };

struct DisplaySpec {
  std::variant<QuiltSpec, StereoSpec, CamerasSpec, LenticularSpec, IntegralSpec, RgbdSpec> kind;
  RayFilter filter;
  std::optional<Pose> world_pose;  // none = stands in the source's camera
  double tolerance_px = 0;         // output px; 0 = of the quality
  OutsideFill outside_fill = OutsideFill::kBorder;
  uint32_t background_rgb = 0;  // 0xRRGGBB, sRGB
  std::optional<ReflectionSpec> reflection = std::nullopt;
  double focus_following_s = 0;  // time constant of the focal plane; 0 = it stays where it is
  std::optional<LensSpec> lens;  // none = everything is sharp
  Quality quality = Quality::kBalanced;
  std::optional<TemporalSpec> temporal;  // none = an atlas a frame
};

// Ranges of proto Display.
inline constexpr double kTolerancePxMax = 16;
inline constexpr double kDefaultTolerance_px = 0.25;  // of balanced quality
inline constexpr uint32_t kJpegSidePxMax = 65500;     // libjpeg's JPEG_MAX_DIMENSION
inline constexpr double kFocusFollowingMin_s = 0.01;
inline constexpr double kFocusFollowingMax_s = 60;

// Checks every range and fills in presets and defaults that need no stream. Errors name the field
// as in proto Display ("quilt.columns"). NOT_FOUND for a preset that does not exist.
absl::StatusOr<DisplaySpec> completeDisplaySpec(DisplaySpec spec);

// The same display with its focal plane elsewhere. Empty where views frame no plane in common, or
// one that is not the display's to move.
std::optional<DisplaySpec> withFocalDistance(DisplaySpec spec, double focal_distance_m);

// kJpegPlanes: red, green and blue as images of one channel each.
enum class BandEncoding : uint8_t { kJpeg, kJpegPlanes, kZstd, kRaw };
enum class Chroma : uint8_t { k420, k444 };

// How the atlas is packed.
struct EncodingSpec {
  BandEncoding color = BandEncoding::kJpeg;
  uint32_t jpeg_quality = 85;  // 1..100
  Chroma chroma = Chroma::k420;
  bool with_depth = false;
  bool with_mask = false;
  bool with_depth_codes = false;              // of displays that are complete only with them
  BandEncoding planes = BandEncoding::kZstd;  // kZstd or kRaw

  bool operator==(const EncodingSpec&) const = default;
};

// Errors name the field as in proto AtlasEncoding.
absl::Status validateEncodingSpec(const EncodingSpec& encoding);
// Of a display: what leaves its picture whole. Shared chroma mixes what neighbouring subpixels of a
// lenticular panel show to different eyes.
absl::Status validateEncodingOf(const DisplaySpec& spec, const EncodingSpec& encoding);

// Expect completed specs. Same key = same picture from the same stream: traced once. What cannot
// change the picture (a preset's name, the JPEG quality of lossless colour) is left out.
std::string displayKey(const DisplaySpec& spec);
std::string encodingKey(const EncodingSpec& encoding);

}  // namespace viewloom
