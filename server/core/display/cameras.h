// SPDX-License-Identifier: Apache-2.0
// A list of posed pinhole cameras, with angles or intrinsics; or a grid of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "display/kind.h"

namespace viewloom {

struct View;

// Off-axis eyes on a grid in one plane. All frame one rectangle on the focal plane.
struct CameraGrid {
  uint32_t columns = 0;
  uint32_t rows = 0;
  glm::dvec2 spacing_m{0.0};    // between neighbours, along x and y
  double focal_distance_m = 0;  // 0 = from the stream
  double fov_y_rad = 0;         // 0 = what the source sees

  uint32_t count() const { return columns * rows; }
};

enum class TileArrangement : uint8_t { kGrid, kRow, kQuad, kSeparate };
inline constexpr Word<TileArrangement> kTileArrangements[] = {
    {"ATLAS", TileArrangement::kGrid},
    {"ROW", TileArrangement::kRow},
    {"QUAD_2X2", TileArrangement::kQuad},
    {"SEPARATE_VIEWS", TileArrangement::kSeparate}};

struct CamerasSpec {
  static constexpr const char* kName = "cameras";

  std::vector<ViewCamera> cameras;  // none with a grid
  std::optional<CameraGrid> grid;
  SizePx tile_size_px;
  uint32_t columns = 0;  // of tiles
  TileOrder order = TileOrder::kTopLeft;
  TileArrangement arrangement = TileArrangement::kGrid;
};

inline constexpr uint32_t kCameraCountMax = 1024;
inline constexpr double kCameraSpacingMax_m = 1000;

template <SpecOf<CameraGrid> Grid, typename Visitor>
void visitFields(Grid& grid, Visitor& visit) {
  visit("columns", grid.columns, Range{1, kCameraCountMax});
  visit("rows", grid.rows, Range{1, kCameraCountMax});
  visit("spacing_x_m", grid.spacing_m.x, Range{0, kCameraSpacingMax_m});
  visit("spacing_y_m", grid.spacing_m.y, Range{0, kCameraSpacingMax_m});
  visit("focal_distance_m", grid.focal_distance_m, kOptionalDistance);
  visit("fov_y_rad", grid.fov_y_rad, kOptionalAngle);
}

template <SpecOf<CamerasSpec> Cameras, typename Visitor>
void visitFields(Cameras& cameras, Visitor& visit) {
  visit.cameras("cameras", cameras.cameras, Range{1, kCameraCountMax, true});
  visit("tile_size", cameras.tile_size_px, Range{1, kEyeSidePxMax});
  visit("columns", cameras.columns, Range{1, kCameraCountMax, true});
  visit.word("order", cameras.order, kTileOrders);
  visit.part("grid", cameras.grid);
  visit.word("arrangement", cameras.arrangement, kTileArrangements);
}

absl::Status takePreset(CamerasSpec& cameras);
absl::Status settle(CamerasSpec& cameras);
TileGrid tileGrid(const CamerasSpec& cameras);
// Lays out the views. Views of a grid count in the order of its tiles: from the left, and from the
// top or the bottom as the order says.
void describe(const CamerasSpec& cameras, const StreamDefaults& defaults, AtlasLayout& layout);
double* focalPlane(CamerasSpec& cameras);
std::optional<OpenFov> openFov(const CamerasSpec& cameras);
std::vector<KnownDevice> devicesOf(const CamerasSpec& any);

// Views of a list of cameras. Expects valid cameras.
std::vector<View> cameraViews(const std::vector<ViewCamera>& cameras, SizePx tile_size_px);

}  // namespace viewloom
