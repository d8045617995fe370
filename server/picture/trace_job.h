// SPDX-License-Identifier: Apache-2.0
// One atlas to be traced: where its views lie and what each sees of the source.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "display/atlas_layout.h"
#include "display/color_form.h"
#include "display/display_spec.h"
#include "frame/color_reach.h"
#include "frame/frame.h"
#include "shared/trace_abi.h"

namespace viewloom {

// Rows of an atlas, full width.
struct BandRows {
  uint32_t first_row = 0;
  uint32_t row_count = 0;
};

// The form of a band's 8-bit colour, and which planes are wanted beside it.
struct TraceOutputs {
  ColorForm color = ColorForm::kRgba;
  bool depth = false;    // 1/Z of the view
  bool mask = false;     // ray classes
  bool linear = false;   // colour before it is rounded to 8 bits
  bool records = false;  // abi::RayRecord per px: for tests, statistics and the heat map

  bool wantsOnlyColor() const { return !(depth || mask || linear || records); }
  bool operator==(const TraceOutputs&) const = default;
};

// Rows of a band at most: 8 rows of MCUs of 16 px.
inline constexpr uint32_t kBandRowsMax = 128;
// Limit for the hits of a lens's walked rays in a band: half of the least that devices bind at
// once. Beyond it there is no second stage.
inline constexpr uint64_t kMetBytesMax = uint64_t{64} << 20;

// A source as views see it; of a cube map, its front face.
struct SeenSource {
  Camera camera;   // intrinsics in px of the depth planes
  SizePx size_px;  // of the depth planes
  bool is_cube_map = false;
  bool mirrors = false;         // SourceFormat::mirrors
  bool is_see_through = false;  // its colour may have alpha

  bool operator==(const SeenSource&) const = default;
};

SeenSource seenSource(const SourceFormat& source);
// Whether some of them mirrors.
bool haveMirrors(std::span<const SeenSource> sources);

// Sources that one job can ask for.
inline constexpr size_t kMergedSourcesMax = 8;

// The walks whose answers are those of one source.
struct JobSource {
  uint32_t first_walk = 0;
  uint32_t walk_count = 1;  // of a cube map, one a face

  bool isCubeMap() const { return walk_count > 1; }
};

// Bounds of rays from many eyes, in one structure.
struct RayBounds {
  abi::EyeAxes eye_axes;
  // Tiles of extent_px whose rays enclose them.
  std::vector<abi::ViewParams> extent;
  SizePx extent_px;
};

struct TraceJob {
  std::shared_ptr<const AtlasLayout> layout;
  double tolerance_px = 0;
  // Row-major from the top left; is_used = 0 where no view stands. The same for each walk, one
  // after the other, and all that for each sample of a px.
  std::vector<abi::ViewParams> tiles;
  uint32_t walk_count = 1;    // structures that rays are walked in
  uint32_t sample_count = 1;  // rays of a px
  // Bounds for displays whose rays do not all start at their view's eye, [walk]; else empty.
  std::vector<RayBounds> bounds;
  // Bounds for other displays with a lens: the tiles seen from the four corners of the square
  // around it, [walk][tile][corner]. Else empty.
  std::vector<abi::ViewParams> lens_bounds;
  std::vector<JobSource> sources;
  std::vector<Pose> source_poses;  // [walk], of the source's camera, or the face's
  OutsideFill outside_fill = OutsideFill::kBorder;
  uint32_t background_rgb = 0;
  std::optional<ReflectionSpec> reflection = std::nullopt;  // as the display asks
  bool has_mirrors = false;                                 // some source mirrors
  // Its lens is gathered by the CPU (lens/band_gatherer.h), over what the middle rays see: those
  // alone are traced.
  bool gathers_on_host = false;

  // Whether reflected rays are to be traced.
  bool reflects() const { return reflection.has_value() && has_mirrors; }
  std::span<const abi::ViewParams> tilesOf(uint32_t walk, uint32_t sample = 0) const {
    const size_t count = tileCount();
    return {tiles.data() + (size_t{sample} * walk_count + walk) * count, count};
  }
  size_t tileCount() const { return tiles.size() / (size_t{sample_count} * walk_count); }
  bool hasEyesBeside() const { return !bounds.empty(); }
  bool hasLens() const { return layout->lens.has_value(); }
  // Whether rays of a px are from beside its eye, but for a lens.
  bool hasFilter() const {
    return std::ranges::any_of(
        layout->samples, [](const RaySample& sample) { return sample.eye_m != glm::dvec2(0.0); });
  }
  // Whether there may be a second stage of the lens: one structure, each px with one eye, and
  // nothing that the walked rays alone know.
  bool hasSecondStage() const {
    return hasLens() && layout->lens->gathered_count > 0 && walk_count == 1 && !hasEyesBeside() &&
           !hasFilter() && !layout->depth_codes && !reflects();
  }
  // Whether the device gathers it: there is room for what its walked rays meet.
  bool mayGather() const {
    const uint64_t met_bytes =
        uint64_t{layout->size_px.width} * kBandRowsMax * sample_count * sizeof(uint32_t);
    return hasSecondStage() && !gathers_on_host && met_bytes <= kMetBytesMax;
  }
  // Px are made of several rays' light.
  bool sumsLight() const { return !gathers_on_host && (sample_count > 1 || mayGather()); }
};

using PicturePtr = std::shared_ptr<const TraceJob>;

// The tiles that tell of all rays of a walk: their own, or those that enclose them.
struct TileRays {
  std::span<const abi::ViewParams> tiles;
  SizePx tile_px;
  bool are_bounds = false;
};
TileRays raysOf(const TraceJob& job, uint32_t walk, uint32_t sample);

// The first walk of each source, 8 bits a source.
abi::uvec2 packFirstWalks(const TraceJob& job);

TraceJob makeTraceJob(std::shared_ptr<const AtlasLayout> layout, const DisplaySpec& spec,
                      const Pose& display_pose, std::span<const SeenSource> sources);
TraceJob makeTraceJob(std::shared_ptr<const AtlasLayout> layout, const DisplaySpec& spec,
                      const Pose& display_pose, const Camera& source_camera, SizePx source_px);
// Sees sources from elsewhere, in the memory that the job has. `display_pose`: where the display
// stands in the world; the views' poses are relative to it.
void aimTraceJob(TraceJob& job, const Pose& display_pose, std::span<const SeenSource> sources);

// Whether all rays of these tiles are plain (shaders/shared/trace_abi.h) for a source whose largest
// inv_z is this, 1/m: then a cheaper kernel serves them.
bool raysArePlain(std::span<const abi::ViewParams> tiles, SizePx tile_px, double inv_z_max);
// Whether all their eyes are in the source's plane, as are those of a display that stands in the
// place of its source's camera: then a cheaper kernel serves them. `inv_z_max`, 1/m: of what rays
// are compared with.
bool eyesAreInPlane(std::span<const abi::ViewParams> tiles, double inv_z_max);

// How far a source's colour is averaged for these tiles: by the view with the smallest px, so that
// none is blurred.
ColorReach colorReach(std::span<const abi::ViewParams> tiles, SizePx tile_px);

// Where the display of a spec stands: its own world pose, else that of the (first) source.
Pose displayPose(const DisplaySpec& spec, const Camera& source_camera);

// One view as a kernel takes it. The tolerance: an error dw in inv_z, seen from an eye at b (source
// camera space, m) along r = (x/f, y/f, 1), moves the picture by f_out |r x b| dw / |r - w b|^2 px.
// Here |r x b| is its largest value over the image, and |r - w b| >= |1 - w b_z|, which the kernel
// applies.
abi::ViewParams makeViewParams(const View& view, const Pose& display_pose,
                               const Camera& source_camera, SizePx source_px, double tolerance_px);

}  // namespace viewloom
