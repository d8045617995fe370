// SPDX-License-Identifier: Apache-2.0
// The kinds of displays, and the ranges of what they are told (proto Display).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>

#include "calibration/calibration.h"
#include "frame/camera.h"
#include "frame/size.h"

namespace viewloom {

enum class TileOrder : uint8_t { kBottomLeft, kTopLeft };
enum class StereoLayout : uint8_t { kSideBySide, kTopBottom, kSeparate };

// How the eyes of a quilt lie in its cone (proto CameraConvention).
enum class CameraConvention : uint8_t { kWebxr, kCore, kBridge };

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
  double aspect = 0;  // 0 = that of a tile
  double view_cone_rad = 0;
  double focal_distance_m = 0;  // 0 = from the stream
  double fov_y_rad = 0;         // 0 = what the source sees
  TileOrder order = TileOrder::kBottomLeft;
  uint32_t view_count = 0;
  CameraConvention convention = CameraConvention::kWebxr;
  double depthiness = 0;  // of the cone; 0 = 1
  // The part of the cone that the views share, 0 = its left end, 1 = its right end.
  double cone_begin = 0;
  double cone_end = 0;  // 0 = 1
};

struct StereoSpec {
  StereoLayout layout = StereoLayout::kSideBySide;
  SizePx eye_size_px;
  double eye_distance_m = 0;     // 0 = 0.063
  double focal_distance_m = 0;   // 0 = from the stream
  double fov_y_rad = 0;          // 0 = what the source sees
  std::vector<ViewCamera> eyes;  // none or two
  bool is_tracked = false;       // the eyes are those of EyePoses, once they come
};

// Off-axis eyes on a grid in one plane, all framing one rectangle on the focal plane.
struct CameraGrid {
  uint32_t columns = 0;
  uint32_t rows = 0;
  glm::dvec2 spacing_m{0.0};    // between neighbours, along x and y
  double focal_distance_m = 0;  // 0 = from the stream
  double fov_y_rad = 0;         // 0 = what the source sees

  uint32_t count() const { return columns * rows; }
};

enum class TileArrangement : uint8_t { kGrid, kRow, kQuad, kSeparate };

struct CamerasSpec {
  std::vector<ViewCamera> cameras;  // none with a grid
  std::optional<CameraGrid> grid;
  SizePx tile_size_px;
  uint32_t columns = 0;  // of tiles
  TileOrder order = TileOrder::kTopLeft;
  TileArrangement arrangement = TileArrangement::kGrid;
};

// A lenticular panel in its own px (proto LenticularDisplay).
struct LenticularSpec {
  std::string preset;
  std::string calibration_json;            // empty once it is completed
  std::optional<Calibration> calibration;  // filled in with the rest
  uint32_t view_count = 0;  // subpixels show the nearest of so many views; 0 = each its own
  double view_cone_rad = 0;
  double focal_distance_m = 0;
  double fov_y_rad = 0;
};

// Microlenses in front of a panel, a picture behind each (proto IntegralDisplay).
struct IntegralSpec {
  std::string preset;
  SizePx panel_px;
  double pixel_pitch_m = 0;
  double lens_pitch_m = 0;
  double focal_length_m = 0;
  uint32_t lens_columns = 0;  // 0 = as many as the panel has room for
  uint32_t lens_rows = 0;
  glm::dvec2 offset_px{0.0};  // of the lenses' middle from the panel's, right and down
  bool is_flipped = false;    // each picture is turned by half a turn
  double scale = 0;           // metres of the scene a metre of the panel; 0 = 1
  double distance_m = 0;      // of the lenses from the display's eye, metres of the scene
};

enum class RgbdForm : uint8_t { kColorDepth, kTwoLayers };
// Where depth lies, seen from colour.
enum class DepthPlacement : uint8_t { kRight, kLeft, kTop, kBottom };

// One view with its depth as grey (proto RgbdDisplay).
struct RgbdSpec {
  std::string preset;
  SizePx view_size_px;
  std::optional<RgbdForm> form;                   // completed: never empty
  std::optional<DepthPlacement> depth_placement;  // completed: where depth lies in the colour
  bool is_black_near = false;
  double near_m = 0;        // 0 = from the stream
  double far_m = 0;         // may be infinite; 0 = from the stream
  double screen_m = 0;      // has the middle code; 0 = the preset's, else the range stays as it is
  double fov_y_rad = 0;     // 0 = what the source sees
  uint32_t depth_bits = 0;  // 8 or 16; 0 = 8
};

// Focal distances are held far inside what binary64 squares without loss.
inline constexpr uint32_t kQuiltGridMax = 50;
inline constexpr uint32_t kQuiltSidePxMax = 16384;
inline constexpr uint32_t kEyeSidePxMax = 8192;
inline constexpr uint32_t kCameraCountMax = 1024;
inline constexpr double kCameraSpacingMax_m = 1000;
inline constexpr double kDepthinessMin = 0.1;
inline constexpr double kDepthinessMax = 4;
inline constexpr double kAspectMin = 0.05;
inline constexpr double kAspectMax = 20;
inline constexpr double kViewAngleMax_rad = 2.6;  // of a cone or a field of view; tan(1.3) = 3.6
inline constexpr double kFocalDistanceMin_m = 1e-6;
inline constexpr double kFocalDistanceMax_m = 1e9;
inline constexpr double kEyeDistanceMax_m = 10;
inline constexpr double kDefaultViewCone_rad = 0.69813170079773183;  // 40 deg
inline constexpr double kDefaultEyeDistance_m = 0.063;
// Of a panel with microlenses: from a phone's px under a lens of two of them to a wall of hogels.
inline constexpr double kPanelLengthMin_m = 1e-7;
inline constexpr double kPanelLengthMax_m = 10;
inline constexpr double kPanelScaleMin = 1e-6;
inline constexpr double kPanelScaleMax = 1e6;
// A lens of fewer px shows one picture to all; a picture of more than that is no lens's.
inline constexpr double kLensPxMin = 1;
inline constexpr double kLensPxMax = 4096;

}  // namespace viewloom
