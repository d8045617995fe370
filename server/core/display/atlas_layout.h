// SPDX-License-Identifier: Apache-2.0
// Places of the views in the atlas, and what they see: a display resolved against a stream.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/status.h"
#include "display/display_spec.h"
#include "display/lens.h"
#include "display/video_stack.h"
#include "frame/stage_times.h"
#include "shared/depth_scale.h"

namespace viewloom {

// One output camera. Pixels are those of its tile, rows from the top, centres at +0.5.
struct View {
  Camera camera;             // pose relative to the display (see AtlasLayout)
  bool shows_depth = false;  // depth as grey instead of colour
  bool is_behind = false;    // shows the hidden surface; the first surface where nothing is hidden
};

// Top-left corner of a tile in the atlas, px from the top left.
struct TileOrigin {
  uint32_t x_px = 0;
  uint32_t y_px = 0;
};

// Microlenses in front of a panel. Each pixel is seen only through the middle of its lens. Pixels
// count from the top left of the panel.
struct MicrolensRays {
  double lens_pitch_px = 1;
  glm::dvec2 first_px{0.0};  // upper left corner of the first lens
  uint32_t columns = 1;
  uint32_t rows = 1;
  glm::dvec2 middle_px{0.0};  // middle of the panel, in front of the display's eye
  double m_per_px = 1;        // metres of the scene for each pixel, at the panel
  double distance_m = 0;      // from the display's eye to the panel
  bool is_flipped = false;    // a pixel shows the view through its lens in the opposite direction
};

// A lenticular panel. Each subpixel is seen from its own place on the line of eyes, to which its
// lens directs it. Let z be its share of the way from the outer end of the first view to that of
// the last. The place is x = distance * tan(view_cone * (z - 1/2)), as between the views of a
// quilt.
struct LenticularRays {
  Calibration calibration;
  double view_cone_rad = 0;
  double distance_m = 1;    // from the line of eyes to the panel
  uint32_t view_count = 0;  // z is rounded to the nearest of so many views; 0 = not rounded
};

// Rays of a view that all come from its eye.
struct PinholeRays {};

using DisplayRays = std::variant<PinholeRays, LenticularRays, MicrolensRays>;

// Meaning of the depth codes of a display that computes its own views: grey beside colour. Codes
// are linear in 1/Z of the view, 1/m (proto DepthCodes).
struct DepthCodes {
  uint32_t bits = 8;           // 8 or 16
  double inv_z_near = 1;       // of the nearest code
  double inv_z_far = 0;        // of the farthest code, less than inv_z_near; may be negative
  bool is_black_near = false;  // else white is near

  uint32_t codeMax() const { return (1U << bits) - 1; }
};

// Scale of the codes, for kernels that write them.
abi::DepthScale scaleOf(const DepthCodes& codes);

// Arrangement of tiles in an atlas.
struct TileArrangementPx {
  SizePx size_px;
  uint32_t columns = 1;
  uint32_t rows = 1;
  SizePx tile_size_px;
  TileOrder order = TileOrder::kTopLeft;
  uint32_t padding_right_px = 0;
  uint32_t padding_top_px = 0;
  uint32_t image_count = 1;
};

// A grid of equal tiles. Only `order` says where each view is.
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
  // Lens in front of every view. Sample i of each channel passes through point i of the lens.
  std::optional<LensRays> lens;
  std::vector<glm::vec2> lens_points;  // of `lens`, as lensPoints() gives them
  // Distance of the focal plane from the display's eyes. Pixels stay on it when an eye moves aside.
  // kNoFocus_m: there is no such plane.
  double eye_focus_m = kNoFocus_m;
  glm::dvec2 view_pitch_m{0.0};  // distance between eyes of neighbouring views, right and up
  // Number of images of equal height, one below the other. Each is encoded on its own.
  uint32_t image_count = 1;
  std::optional<DepthCodes> depth_codes;  // RGBD displays
  // Views of a video lie in the pictures of a stack, each of which is an image of this layout.
  std::optional<VideoStack> stack;
  TileArrangementPx unstacked;  // with a stack: what clients make of it

  // The arrangement that the display asks for, and that clients show.
  TileArrangementPx shown() const;
  SizePx imageSize() const { return {size_px.width, size_px.height / image_count}; }

  TileOrigin tileOrigin(uint32_t view) const;
  // Distance of the plane at eye_focus_m from a view that stands in front of the display's eyes, or
  // behind them. kNoFocus_m if the plane is not in front of the view.
  double focusOf(const View& view) const { return distanceOf(eye_focus_m, view); }
  // The same for a plane that is `plane_m` in front of the display's eyes.
  double distanceOf(double plane_m, const View& view) const;
  // View whose tile is in this column and this row from the top; views.size() if there is none.
  uint32_t viewAt(uint32_t column, uint32_t row_from_top) const;
};

struct EyePoses;

// Values from a stream for fields that a display leaves open.
struct StreamDefaults {
  Intrinsics source_intrinsics;
  SizePx source_size_px;
  double focal_distance_m = 1;  // harmonic mean of the 2nd and 98th depth percentile, of a frame
  double inv_z_near = 1;        // 1/m, 2nd depth percentile of that frame
  double inv_z_far = 0;         // the 98th

  bool operator==(const StreamDefaults&) const = default;
};

// Focal distance from content: the harmonic mean of the 2nd and 98th depth percentile, between the
// nearest and the farthest surface. For a stream of only sky, the default of StreamDefaults.
double contentFocalDistance(const SourceStats& stats);
// Defaults from a source. `stats` are those of the frame they are taken from (taken_defaults.h).
StreamDefaults streamDefaults(const Intrinsics& intrinsics, SizePx size_px,
                              const SourceStats& stats);

// Largest atlas that this device and this server accept.
struct AtlasLimits {
  uint32_t side_px_max = 16384;
  uint64_t area_px_max = uint64_t{16384} * 16384;
  uint32_t view_count_max = 2500;
};

// Resolves a display against a stream. Expects a completed spec. Errors name the field as in proto
// Display. `eyes` are those of a tracked display; nullptr if none came yet.
absl::StatusOr<AtlasLayout> makeAtlasLayout(const DisplaySpec& spec, const StreamDefaults& defaults,
                                            const EyePoses* eyes = nullptr);
// Moves the views from the arrangement that the display asks for into a stack. Expects a layout of
// pinholes without one. RESOURCE_EXHAUSTED if a view is too large for video.
absl::Status stackViews(AtlasLayout& layout);
// Tiles of a display, without a stream. Expects a completed spec.
TileGrid tileGridOf(const DisplaySpec& spec);
// Number of rays that an atlas takes, without gathered and reflected rays.
int64_t rayCount(const DisplaySpec& spec);
// Checks sizes and counts before anything is allocated. Needs no stream.
absl::Status validateAtlasLimits(const DisplaySpec& spec, const AtlasLimits& limits);

// Rows of a band: 8 MCU rows, so that restart markers run on from band to band. Colour of a video
// has one band an image; this is then the height of what is packed at a time, and of other planes'
// bands.
uint32_t bandRowCount(const EncodingSpec& encoding);

}  // namespace viewloom
