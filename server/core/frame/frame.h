// SPDX-License-Identifier: Apache-2.0
// A frame: one instant, decoded, on its way from ingest to upload. Immutable.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/byte_pool.h"
#include "frame/camera.h"
#include "frame/size.h"

namespace viewloom {

enum class PlaneKind : uint8_t { kColor, kDepth, kMotion, kNormal, kRoughness, kSpecular };
enum class PlaneEncoding : uint8_t {
  kRgba8,
  kRgb8,
  kRgba16f,
  kJpeg,
  kH264,
  kDepthF32,
  kDepthF16,
  kDepthU16,
  kXyz16f,
  kXyz8,
  kOct16,
  kR8
};
enum class PlaneCompression : uint8_t { kNone, kZstd, kPredictedZstd };
enum class ColorTransfer : uint8_t { kSrgb, kLinear };
enum class ColorPrimaries : uint8_t { kBt709, kDisplayP3, kBt2020 };
enum class AlphaMode : uint8_t { kOpaque, kPremultiplied, kStraight };
enum class NormalSpace : uint8_t { kCamera, kWorld };
// Mapping of light brighter than white, for planes of linear colour (proto ToneMap).
enum class ToneMap : uint8_t { kClip, kFilmic, kAgx };
enum class DepthMeaning : uint8_t { kPlanar, kRayDistance, kWindow, kDisparity };

// Conversion of depth samples to 1/Z. frame/depth.h makes coefficients for kernels of it.
struct DepthFormat {
  DepthMeaning meaning = DepthMeaning::kPlanar;
  double scale = 1;      // metres, or 1/m, for each unit of the sample
  double offset = 0;     // added after the scale
  double min_depth = 0;  // kWindow, as in XrCompositionLayerDepthInfoKHR
  double max_depth = 1;
  double near_z_m = 0;  // may be +inf; near > far is reversed depth
  double far_z_m = 0;
  std::optional<double> invalid_value;
  bool invalid_is_far = false;
};

// Description of a plane without its bytes.
struct PlaneFormat {
  PlaneKind kind = PlaneKind::kColor;
  PlaneEncoding encoding = PlaneEncoding::kRgba8;
  SizePx size_px;
  uint32_t stride_bytes = 0;  // 0 = packed
  PlaneCompression compression = PlaneCompression::kNone;
  ColorTransfer transfer = ColorTransfer::kSrgb;
  ColorPrimaries primaries = ColorPrimaries::kBt709;
  AlphaMode alpha = AlphaMode::kOpaque;
  DepthFormat depth;
  NormalSpace normal_space = NormalSpace::kCamera;
  uint64_t wire_bytes = 0;  // as declared
};

struct LayerFormat {
  PlaneFormat color;
  PlaneFormat depth;
  bool depth_first = false;  // depth came before colour on the wire
  // Planes of other kinds after those two, in the order of the wire; at most one of each kind.
  std::vector<PlaneFormat> others = {};
  bool color_has_reflections = false;

  // Plane of this kind among `others`; nullptr if there is none.
  const PlaneFormat* find(PlaneKind kind) const {
    for (const PlaneFormat& plane : others) {
      if (plane.kind == kind) return &plane;
    }
    return nullptr;
  }
  // Whether reflections are added to the colour if a display asks for them.
  bool mirrors() const { return find(PlaneKind::kSpecular) != nullptr && !color_has_reflections; }
};

struct SourceFormat {
  Camera camera;  // intrinsics in pixels of the depth planes, or of the front face of a cube map
  std::vector<LayerFormat> layers;  // 1..4, nearest first
  double connection_tolerance = 0;  // 1/m; 0 = measured
  // Every plane holds six faces, one below the other (frame/cube_map.h).
  bool is_cube_map = false;

  bool mirrors() const {
    return std::any_of(layers.begin(), layers.end(),
                       [](const LayerFormat& layer) { return layer.mirrors(); });
  }
};

// A frame without its bytes: a header that validateFrame accepts.
struct FrameFormat {
  uint64_t number = 0;
  int64_t capture_time_ns = 0;
  std::vector<SourceFormat> sources;
  double exposure_ev = 0;
  ToneMap tone_map = ToneMap::kClip;
};

// Decoded, packed planes, top row first.
//   color    uint8_t[h][w][4] for kRgba8 (also from kRgb8, kJpeg, kH264), or binary16[h][w][4]
//   depth    samples as declared
//   surface  abi::SurfaceTexel[h][w] for a layer that mirrors; else null
struct LayerPlanes {
  SharedBytes color;
  PlaneEncoding color_encoding = PlaneEncoding::kRgba8;  // kRgba8 or kRgba16f
  SharedBytes depth;
  SharedBytes surface = nullptr;
  uint64_t bad_normals_count = 0;  // normals without length; the slope of the depth is used there
  // Motion of the surfaces, m/s along the axes of the world, binary16[h][w][3], finite; null if
  // nothing moves.
  SharedBytes motion = nullptr;
  uint64_t bad_motions_count = 0;  // motions that were not finite; the surface stands still there
};

// Times of a frame, on the server's monotonic clock.
struct FrameTimes {
  int64_t first_chunk_ns = 0;
  int64_t last_chunk_ns = 0;
  int64_t decoded_ns = 0;
};

struct Frame {
  FrameFormat format;
  std::vector<std::vector<LayerPlanes>> sources;  // [source][layer]
  FrameTimes times;
  std::string publisher{};  // whose share of the memory it takes: an address; empty = the server's
};

using FramePtr = std::shared_ptr<const Frame>;

}  // namespace viewloom
