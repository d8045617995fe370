// SPDX-License-Identifier: Apache-2.0
// A display that a client asks for, checked, with every default except those from the stream.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "base/status.h"
#include "base/video_rung.h"
#include "display/display_kinds.h"
#include "display/effects.h"
#include "display/fields.h"
#include "display/ray_samples.h"
#include "display/video_stack.h"
#include "frame/camera.h"

namespace viewloom {

enum class OutsideFill : uint8_t { kBorder, kBackground };
inline constexpr Word<OutsideFill> kOutsideFills[] = {{"BORDER", OutsideFill::kBorder},
                                                      {"BACKGROUND", OutsideFill::kBackground}};

struct DisplaySpec {
  DisplayKind kind;
  RayFilter filter;
  std::optional<Pose> world_pose;  // none = in the source's camera
  double tolerance_px = 0;         // px of the atlas; 0 = as quality says
  OutsideFill outside_fill = OutsideFill::kBorder;
  uint32_t background_rgb = 0;  // 0xRRGGBB, sRGB
  std::optional<ReflectionSpec> reflection = std::nullopt;
  double focus_following_s = 0;  // time constant of the focal plane; 0 = it stays where it is
  std::optional<LensSpec> lens;  // none = everything is sharp
  Quality quality = Quality::kBalanced;
  std::optional<TemporalSpec> temporal;  // none = one atlas for each frame
};

template <SpecOf<DisplaySpec> Display, typename Visitor>
void visitFields(Display& display, Visitor& visit) {
  visit.kind(display.kind);
  visit.pose("world_pose", display.world_pose);
  visit("tolerance_px", display.tolerance_px, Range{0, 16});
  visit.word("outside_fill", display.outside_fill, kOutsideFills);
  visit.color("background_rgb", display.background_rgb);
  visit.group("effects", [&] {
    visit.part("lens", display.lens);
    visit.part("temporal", display.temporal);
    visit.part("reflection", display.reflection);
  });
  visit.group("filter", [&] {
    visit("sample_count", display.filter.sample_count, Range{1, kFilterSampleCountMax});
    visit("width", display.filter.width, Range{0, kFilterWidthMax});
  });
  visit("focus_following_s", display.focus_following_s, Range{0.01, 60, true});
  visit.label("quality", display.quality, kQualities);
}

inline constexpr double kDefaultTolerance_px = 0.25;  // with balanced quality
inline constexpr uint32_t kJpegSidePxMax = 65500;     // libjpeg's JPEG_MAX_DIMENSION

// Range of a number by its path in proto Display ("quilt.columns", "quilt.size.width"). Expects a
// field that has a range.
Range rangeOf(std::string_view field);
// Ranges of all fields by their paths.
const std::map<std::string, Range, std::less<>>& fieldRanges();

// Checks every range and fills in presets and defaults that need no stream. Errors name the field
// as in proto Display ("quilt.columns"). NOT_FOUND for a preset that does not exist.
absl::StatusOr<DisplaySpec> completeDisplaySpec(DisplaySpec spec);

// The same display with its focal plane at another distance. Empty if its views frame no common
// plane, or a plane that cannot move.
std::optional<DisplaySpec> withFocalDistance(DisplaySpec spec, double focal_distance_m);

// Packing of a band. kJpegPlanes: red, green and blue as one grey JPEG each. kH264: one picture of
// a stack (video_stack.h). kCompactDepth: see encode/compact_depth.h.
enum class BandEncoding : uint8_t { kJpeg, kJpegPlanes, kZstd, kRaw, kH264, kCompactDepth };
inline constexpr size_t kBandEncodingCount = 6;
enum class Chroma : uint8_t { k420, k444 };

// Packing of the atlas.
struct EncodingSpec {
  BandEncoding color = BandEncoding::kJpeg;
  uint32_t jpeg_quality = 85;  // 1..100
  Chroma chroma = Chroma::k420;
  bool with_depth = false;
  bool with_mask = false;
  bool with_depth_codes = false;              // displays with 16-bit depth need them
  BandEncoding planes = BandEncoding::kZstd;  // kZstd or kRaw; of depth alone, kCompactDepth
  uint32_t video_qp = 24;                     // finest one of kH264, kVideoQpMin..kVideoQpMax
  // Coarsest one that the server may choose, up to kVideoQpMax. Up to video_qp, it chooses none.
  uint32_t video_qp_max = 0;
  uint64_t bits_per_second_max = 0;  // of kH264, for each viewer; 0 = as many as its line takes
  Prediction prediction = Prediction::kWithinAtlas;  // of kH264
  VideoRung rung = VideoRung::kFirst;                // of video whose quality adapts

  bool operator==(const EncodingSpec&) const = default;
};

// Whether the server chooses the quantisation, atlas by atlas.
bool adaptsQuality(const EncodingSpec& encoding);
// The same, or whether it keeps viewers to a rate.
bool adaptsToLines(const EncodingSpec& encoding);
// Number of the rung, as proto AtlasLayout has it: 1 or 2; 0 = the quality does not adapt.
uint32_t rungNumber(const EncodingSpec& encoding);
// The same video on the other rung.
EncodingSpec onOtherRung(EncodingSpec encoding);
// Whether atlases may refer to the one before.
bool isChained(const EncodingSpec& encoding);

// Coarsest quantisation that the server may choose where this is the finest.
uint32_t coarsestAdaptedQp(uint32_t finest_qp);

// Quantisation of H.264 whose error is at most that of a JPEG of this quality, 1..100.
uint32_t matchedVideoQp(uint32_t jpeg_quality);

// Checks an encoding. Errors name the field as in proto AtlasEncoding.
absl::Status validateEncodingSpec(const EncodingSpec& encoding);
// Checks that an encoding keeps the picture of a display whole. Shared chroma mixes the pictures
// that neighbouring subpixels of a lenticular panel show to different eyes. Video takes views,
// which neither lenses nor depth beside colour are. RESOURCE_EXHAUSTED for views too large for
// video.
absl::Status validateEncodingOf(const DisplaySpec& spec, const EncodingSpec& encoding);

// Keys of completed specs. The same key means the same picture from the same stream, which is
// rendered once. Values that cannot change the picture are left out: a preset's name, the JPEG
// quality of lossless colour.
std::string displayKey(const DisplaySpec& spec);
std::string encodingKey(const EncodingSpec& encoding);
// Key of the arrangement in which an encoding takes the views. Different arrangements of one
// display are rendered apart.
std::string arrangementKey(const EncodingSpec& encoding);

}  // namespace viewloom
