// SPDX-License-Identifier: Apache-2.0
// Functions of every kind of display. A kind is a struct with a name (kName), a field list, and
// these functions (CONTRIBUTING.md shows how to add one):
//   absl::Status takePreset(Spec&)         fills what the named device gives; before the checks
//   absl::Status settle(Spec&)             fills the rest, and checks fields against each other
//   TileGrid tileGrid(const Spec&)         the atlas without a stream
//   void describe(const Spec&, const StreamDefaults&, AtlasLayout&)   its views and rays
//   double* focalPlane(Spec&)              distance of the plane that all views frame
//   std::optional<OpenFov> openFov(const Spec&)
//   std::vector<KnownDevice> devicesOf(const Spec&)
// tileGrid, describe, focalPlane and openFov expect a completed spec.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "display/fields.h"
#include "frame/size.h"

namespace viewloom {

struct AtlasLayout;
struct StreamDefaults;

// kStacked: as AtlasLayout::stack says; no display asks for it.
enum class TileOrder : uint8_t { kBottomLeft, kTopLeft, kStacked };
inline constexpr Word<TileOrder> kTileOrders[] = {{"BOTTOM_LEFT", TileOrder::kBottomLeft},
                                                  {"TOP_LEFT", TileOrder::kTopLeft}};

// Tiles of a display, before any stream is known.
struct TileGrid {
  const char* size_field;  // field that the client can make smaller
  uint32_t columns;
  uint32_t rows;
  SizePx tile_size_px;
  TileOrder order;
  uint32_t view_count;
  uint64_t width_px;  // of the atlas; 64 bits, because it is not checked yet
  uint64_t height_px;
  uint32_t image_count = 1;  // see AtlasLayout
  uint32_t rays_per_px = 1;  // 3 if each channel of a pixel has its own eye
};

// A device that has a display of this kind.
struct KnownDevice {
  std::string_view name;    // "portrait"
  std::string_view device;  // "Looking Glass Portrait"
  std::string_view note;    // where published sources disagree; "" = nowhere
  SizePx panel_px;          // of its panel; none = unknown or irrelevant
  double panel_dpi = 0;
  bool has_size = true;  // false: the client gives the size of the atlas
};

// Field of view of a display; 0 means that the stream gives it.
struct OpenFov {
  const char* field;
  double fov_y_rad;
};

inline constexpr uint32_t kEyeSidePxMax = 8192;
inline constexpr uint32_t kQuiltSidePxMax = 16384;

}  // namespace viewloom
