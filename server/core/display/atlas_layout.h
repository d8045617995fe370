// SPDX-License-Identifier: Apache-2.0
// Where each view lies in the atlas and what it sees: a display resolved against a stream.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/status.h"
#include "display/display_spec.h"
#include "display/lens.h"
#include "frame/stage_times.h"
#include "shared/depth_scale.h"

namespace viewloom {

// One output camera. Pixels are those of its tile, rows from the top, centres at +0.5.
struct View {
  Camera camera;             // pose relative to the display (see AtlasLayout)
  bool shows_depth = false;  // as grey, instead of colour
  bool is_behind = false;    // shows what lies behind the first surface; that, where nothing does
};

// Top-left corner of a tile in the atlas, px from the top left.
struct TileOrigin {
  uint32_t x_px = 0;
  uint32_t y_px = 0;
};

// Microlenses in front of a panel: each px is seen through the middle of its lens alone. Px from
// the top left of the panel.
struct MicrolensRays {
  double lens_pitch_px = 1;
  glm::dvec2 first_px{0.0};  // upper left corner of the first lens
  uint32_t columns = 1;
  uint32_t rows = 1;
  glm::dvec2 middle_px{0.0};  // of the panel, in front of the display's eye
  double m_per_px = 1;        // of the scene, where the panel is
  double distance_m = 0;      // from the display's eye to the panel
  bool is_flipped = false;    // each px shows what is seen through its lens in the other direction
};

// A lenticular panel: every subpixel is seen from a place of its own on the line of eyes, which its
// lens sends it to; at z of the way from the first view's outer end to the last one's,
// x = distance * tan(view_cone * (z - 1/2)), as between the views of a quilt.
struct LenticularRays {
  Calibration calibration;
  double view_cone_rad = 0;
  double distance_m = 1;    // from the line of eyes to the panel
  uint32_t view_count = 0;  // z is that of the nearest of so many views; 0 = its own
};

// All rays of a view come from its eye.
struct PinholeRays {};

using DisplayRays = std::variant<PinholeRays, LenticularRays, MicrolensRays>;

// Meaning of the depth codes of a display: grey beside colour, for displays that make their own
// views. Linear in 1/Z of the view, 1/m (proto DepthCodes).
struct DepthCodes {
  uint32_t bits = 8;           // 8 or 16
  double inv_z_near = 1;       // of the nearest code
  double inv_z_far = 0;        // of the farthest, less than that; negative: further than infinity
  bool is_black_near = false;  // else white is near

  uint32_t codeMax() const { return (1U << bits) - 1; }
};

// Scale of the codes, for those who make them.
abi::DepthScale scaleOf(const DepthCodes& codes);

// A grid of equal tiles. `order` is the only statement about where views are.
struct AtlasLayout {
  SizePx size_px;
  uint32_t columns = 1;
  uint32_t rows = 1;
  SizePx tile_size_px;
  TileOrder order = TileOrder::kTopLeft;
  double aspect = 1;  // of a view as shown
  uint32_t padding_right_px = 0;
  uint32_t padding_top_px = 0;
  double view_cone_rad = 0;  // quilts and lenticular panels
  double cone_begin = 0;     // the part of the cone that the views of a quilt share
  double cone_end = 0;
  double focal_distance_m = 0;  // quilts, stereo, lenticular panels and grids of cameras
  std::string suffix;           // quilts: "_qs8x6a0.75"
  std::vector<View> views;      // [view]
  DisplayRays rays;
  std::vector<RaySample> samples = {RaySample{}};  // of each px
  // Before every view: sample i passes through point i of it, of each channel.
  std::optional<LensRays> lens;
  std::vector<glm::vec2> lens_points;  // of `lens`, as lensPoints() gives them
  // Seen from beside, px stay on what is so far in front of the display's eyes; kNoFocus_m: no such
  // plane.
  double eye_focus_m = kNoFocus_m;
  glm::dvec2 view_pitch_m{0.0};  // between the eyes of neighbouring views, to the right and up
  // So many images of equal height, one below the other, each encoded by itself.
  uint32_t image_count = 1;
  std::optional<DepthCodes> depth_codes;  // RGBD displays

  SizePx imageSize() const { return {size_px.width, size_px.height / image_count}; }

  TileOrigin tileOrigin(uint32_t view) const;
  // Of the plane at eye_focus_m from a view that stands in front of the display's eyes, or behind
  // them; kNoFocus_m where it is not in front of the view.
  double focusOf(const View& view) const { return distanceOf(eye_focus_m, view); }
  // The same of a plane that is `plane_m` in front of the display's eyes.
  double distanceOf(double plane_m, const View& view) const;
  // The view whose tile stands in this column and this row from the top; views.size() = none.
  uint32_t viewAt(uint32_t column, uint32_t row_from_top) const;
};

struct EyePoses;

// What a stream gives a display that leaves it open.
struct StreamDefaults {
  Intrinsics source_intrinsics;
  SizePx source_size_px;
  double focal_distance_m = 1;  // harmonic mean of the 2nd and 98th depth percentile, of a frame
  double inv_z_near = 1;        // 1/m, 2nd depth percentile of that frame
  double inv_z_far = 0;         // the 98th

  bool operator==(const StreamDefaults&) const = default;
};

// A focal distance from content: the harmonic mean of the 2nd and 98th depth percentile, not beyond
// the nearest or the furthest surface. A stream of sky alone has none; then the default of
// StreamDefaults.
double contentFocalDistance(const SourceStats& stats);
// What such a source gives, `stats` being those of that frame (display/taken_defaults.h).
StreamDefaults streamDefaults(const Intrinsics& intrinsics, SizePx size_px,
                              const SourceStats& stats);

// Largest atlas of this device and this server.
struct AtlasLimits {
  uint32_t side_px_max = 16384;
  uint64_t area_px_max = uint64_t{16384} * 16384;
  uint32_t view_count_max = 2500;
};

// Expects a completed spec. Errors name the field as in proto Display.
// `eyes`: of a tracked display; nullptr = none came yet.
absl::StatusOr<AtlasLayout> makeAtlasLayout(const DisplaySpec& spec, const StreamDefaults& defaults,
                                            const EyePoses* eyes = nullptr);
// Its tiles, without a stream. Expects a completed spec.
TileGrid tileGridOf(const DisplaySpec& spec);
// Rays that such an atlas takes. Rays that are gathered or mirrored are not counted.
int64_t rayCount(const DisplaySpec& spec);
// Without a stream: checks sizes and counts before anything is allocated.
absl::Status validateAtlasLimits(const DisplaySpec& spec, const AtlasLimits& limits);

// Rows of a band: 8 MCU rows, so that restart markers run on from band to band.
uint32_t bandRowCount(const EncodingSpec& encoding);

}  // namespace viewloom
