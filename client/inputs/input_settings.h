// SPDX-License-Identifier: Apache-2.0
// Settings of a user about input files: which tool wrote them, and what their samples mean if the
// files do not say it.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "viewloom/v1/frame.pb.h"
#include "viewloom/v1/manifest.pb.h"

namespace viewloom::inputs {

enum class InputKind {
  kAuto,     // by the file's header, else kPlain
  kPlain,    // colour and depth as the settings say
  kBlender,  // multilayer EXR of Blender
  kUnreal,   // EXR of Unreal's Movie Render Queue
  kNuke,     // EXR of Nuke: depth is 1/Z
  kArnold,   // EXR of these renderers: Z in scene units
  kVray,
  kRedshift,
  kHoudini,
  kRgbd,      // colour and depth halves of one picture
  k2dPlusZ,   // 2D-plus-Depth: disparity about a screen, beside the colour
  kSensor,    // depth camera: whole numbers of millimetres, 0 = nothing measured
  kOpenXr,    // depth buffer between two planes
  kTmiv,      // MPEG's test model: camera JSON, normalised disparity
  kIphone,    // disparity in 1/m, or normalised between two of them
  kRelative,  // inverse depth of unknown scale, as networks estimate it
  kKitti,     // KITTI: 1 / 256 m, or 1 / 256 px of disparity with a baseline, 0 = nothing
  kTum,       // TUM RGB-D: 1 / 5000 m, 0 = nothing
  kL515,      // RealSense L515: 0.25 mm, 0 = nothing
  kD405,      // RealSense D405: 0.1 mm, 0 = nothing
  kRecord3d,  // Record3D: metres as floats, or millimetres, 0 = nothing
};

// How the px of a picture lie around the camera.
enum class Projection {
  kFlat,      // a pinhole's picture
  kEquirect,  // all directions: longitude across, latitude down, the middle is ahead
  kCube,      // OpenEXR's cube: six faces, one below the other
};

// Name that --input takes: "blender".
std::string nameOf(InputKind kind);

// Values left open come from the kind of input.
struct InputSettings {
  InputKind kind = InputKind::kAuto;

  v1::DepthMeaning depth_meaning = v1::DEPTH_MEANING_UNSPECIFIED;
  std::optional<double> depth_scale;
  std::optional<double> depth_offset;
  std::optional<double> near_m;  // of the nearest code, or of the window's near plane
  std::optional<double> far_m;
  std::optional<double> min_depth;
  std::optional<double> max_depth;
  std::optional<double> depth_invalid;
  bool depth_invalid_is_far = false;
  bool depth_far_zero = false;
  std::optional<double> no_surface_beyond_m;
  std::optional<double> baseline_m;  // depth is disparity in px of two cameras so far apart
  v1::DepthPacking depth_packing = v1::DEPTH_PACKING_UNSPECIFIED;
  bool flips_depth = false;  // rows are stored the other way round
  bool flips_color = false;
  double connection_tolerance = 0;  // 1/m; 0 = measured

  v1::ColorTransfer transfer = v1::COLOR_TRANSFER_UNSPECIFIED;
  v1::ColorPrimaries primaries = v1::COLOR_PRIMARIES_UNSPECIFIED;
  v1::AlphaMode alpha = v1::ALPHA_MODE_UNSPECIFIED;
  v1::ToneMap tone_map = v1::TONE_MAP_UNSPECIFIED;

  std::optional<double> fov_y_deg;   // 40 without any word of a camera
  std::optional<double> focal_px;    // instead of fov_y_deg, in shorter sides of the depth's px
  std::vector<double> principal_px;  // none = the middle
  std::optional<double> pixel_aspect;
  bool looks_along_minus_z = false;  // cameras of EXR matrices: else along +z

  // EXR: a layer, or channels ("R,G,B"); a channel; "" = by their names.
  std::string color_channels;
  std::string depth_channel;
  std::optional<Projection> projection;  // none = the file's

  v1::ImagePart depth_side = v1::IMAGE_PART_RIGHT;  // kRgbd, k2dPlusZ
  bool is_black_near = false;                       // kRgbd, kRelative
  std::optional<uint32_t> white_code;               // whole numbers; none = the file's last
  double screen_m = 1;                              // k2dPlusZ
  double factor = 64;                               // k2dPlusZ, of 64 = 100 %
  double screen_code = 128;                         // k2dPlusZ: the code that lies in the screen
  std::string camera_file;                          // kTmiv
  std::string camera_name;                          // kTmiv; "" = by the name of the depth file

  // The options among these that a user gave, as "--depth-scale". What is given has to count.
  std::set<std::string> given;
};

// The files of one frame.
struct InputFiles {
  std::string color;
  std::string depth;         // "" = the colour file has depth, too
  std::string view;          // of multi-view EXR files; "" = the default one
  uint32_t video_frame = 0;  // of .yuv files
};

}  // namespace viewloom::inputs
