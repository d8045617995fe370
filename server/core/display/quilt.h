// SPDX-License-Identifier: Apache-2.0
// Quilts: N off-axis views from a line of eyes, never toed in, as lenticular panels show them.
#pragma once

#include <string>
#include <vector>

#include "display/kind.h"

namespace viewloom {

// Places of the eyes of a quilt in its cone (proto CameraConvention).
enum class CameraConvention : uint8_t { kWebxr, kCore, kBridge };
inline constexpr Word<CameraConvention> kCameraConventions[] = {
    {"WEBXR", CameraConvention::kWebxr},
    {"CORE", CameraConvention::kCore},
    {"BRIDGE", CameraConvention::kBridge}};

// Off-axis views from a line of eyes. Fields of 0 come from the stream or the preset (proto
// QuiltDisplay).
struct QuiltSpec {
  static constexpr const char* kName = "quilt";

  std::string preset;  // name that it came from, for the catalogue; "" = none
  uint32_t columns = 0;
  uint32_t rows = 0;
  SizePx size_px;
  double aspect = 0;  // 0 = that of a tile
  double view_cone_rad = 0;
  double focal_distance_m = 0;  // 0 = from the stream
  double fov_y_rad = 0;         // 0 = what the source sees
  TileOrder order = TileOrder::kBottomLeft;
  uint32_t view_count = 0;
  CameraConvention convention = CameraConvention::kWebxr;
  double depthiness = 0;  // widens the cone; 0 = 1
  // Part of the cone that the views share: 0 is its left end, 1 its right end.
  double cone_begin = 0;
  double cone_end = 0;  // 0 = 1
};

inline constexpr uint32_t kQuiltGridMax = 50;

template <SpecOf<QuiltSpec> Quilt, typename Visitor>
void visitFields(Quilt& quilt, Visitor& visit) {
  visit.label("preset", quilt.preset);
  visit("columns", quilt.columns, Range{1, kQuiltGridMax});
  visit("rows", quilt.rows, Range{1, kQuiltGridMax});
  visit("size", quilt.size_px, Range{1, kQuiltSidePxMax});
  visit("aspect", quilt.aspect, Range{0.05, 20, true});
  visit("view_cone_rad", quilt.view_cone_rad, kOptionalAngle);
  visit("focal_distance_m", quilt.focal_distance_m, kOptionalDistance);
  visit("fov_y_rad", quilt.fov_y_rad, kOptionalAngle);
  visit.word("order", quilt.order, kTileOrders);
  visit("view_count", quilt.view_count, Range{1, kQuiltGridMax * kQuiltGridMax, true});
  visit.word("convention", quilt.convention, kCameraConventions);
  visit("depthiness", quilt.depthiness, Range{0.1, 4, true});
  visit("cone_begin", quilt.cone_begin, Range{0, 1});
  visit("cone_end", quilt.cone_end, Range{0, 1});
}

absl::Status takePreset(QuiltSpec& quilt);
absl::Status settle(QuiltSpec& quilt);
TileGrid tileGrid(const QuiltSpec& quilt);
void describe(const QuiltSpec& quilt, const StreamDefaults& defaults, AtlasLayout& layout);
double* focalPlane(QuiltSpec& quilt);
std::optional<OpenFov> openFov(const QuiltSpec& quilt);
std::vector<KnownDevice> devicesOf(const QuiltSpec& any);

// Width / height of a view as shown. Expects a completed spec.
double quiltAspect(const QuiltSpec& quilt);

// Place of view i of N on the line of eyes, m from its middle, for a focal plane at distance D. t
// is its share of the way from the first to the last, in [-0.5, 0.5]. For a part of the cone, t
// runs over that part. The formulas are those of Looking Glass software by public sources; none is
// verified on hardware:
//   webxr   D tan(depthiness cone t), t = (i + 0.5) / N - 0.5: each in the middle of its share
//   Core    D tan(depthiness cone t), t = i / (N - 1) - 0.5: the outermost at the cone's edges
//   Bridge  D depthiness tan(cone) t, t = i / (N - 1) - 0.5: at equal distances
// View 0 is the leftmost. Expects a completed spec.
double quiltEye(const QuiltSpec& quilt, uint32_t view, double distance_m);

}  // namespace viewloom
