// SPDX-License-Identifier: Apache-2.0
// What every kind of display says of itself. A kind is a struct with a name (kName), a field list,
// and these functions (CONTRIBUTING.md shows how to add one):
//   absl::Status takePreset(Spec&)         fills what the named device gives; before the checks
//   absl::Status settle(Spec&)             fills the rest, and checks fields against each other
//   TileGrid tileGrid(const Spec&)         the atlas without a stream
//   void describe(const Spec&, const StreamDefaults&, AtlasLayout&)   its views and rays
//   double* focalPlane(Spec&)              distance of the plane that all views frame
//   std::optional<OpenFov> openFov(const Spec&)
//   std::vector<KnownDevice> devicesOf(const Spec&)
// The last five expect a completed spec, but for the last one, which expects any.
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

enum class TileOrder : uint8_t { kBottomLeft, kTopLeft };
inline constexpr Word<TileOrder> kTileOrders[] = {{"BOTTOM_LEFT", TileOrder::kBottomLeft},
                                                  {"TOP_LEFT", TileOrder::kTopLeft}};

// The tiles of a display and where they stand, before any stream is known.
struct TileGrid {
  const char* size_field;  // what the client would have to make smaller
  uint32_t columns;
  uint32_t rows;
  SizePx tile_size_px;
  TileOrder order;
  uint32_t view_count;
  uint64_t width_px;  // of the atlas; 64 bits: not yet known to be within limits
  uint64_t height_px;
  uint32_t image_count = 1;  // see AtlasLayout
  uint32_t rays_per_px = 1;  // 3 where each channel of a px is seen from a place of its own
};

// A device that has a display of this kind.
struct KnownDevice {
  std::string_view name;    // "portrait"
  std::string_view device;  // "Looking Glass Portrait"
  std::string_view note;    // where sources disagree; "" = they do not
  SizePx panel_px;          // of its panel; none = it is not known, or does not matter
  double panel_dpi = 0;
  bool has_size = true;  // false: its atlas has whatever size the client says
};

// The field of view that the stream gives a display where it is 0.
struct OpenFov {
  const char* field;
  double fov_y_rad;
};

inline constexpr uint32_t kEyeSidePxMax = 8192;
inline constexpr uint32_t kQuiltSidePxMax = 16384;

}  // namespace viewloom
