// SPDX-License-Identifier: Apache-2.0
#include "frame/same_content.h"

#include <algorithm>
#include <tuple>

#include "frame/plane_encoding.h"

namespace viewloom {
namespace {

// Compared values of each format. Every struct is listed with all of its fields, so a new field
// does not compile until this file says whether it counts.

auto contentOf(const DepthFormat& format) {
  const auto& [meaning, scale, offset, min_depth, max_depth, near_z_m, far_z_m, invalid_value,
               invalid_is_far] = format;
  return std::tuple(meaning, scale, offset, min_depth, max_depth, near_z_m, far_z_m, invalid_value,
                    invalid_is_far);
}

PlaneEncoding decodedEncoding(PlaneEncoding encoding) {
  return becomesRgba8(encoding) ? PlaneEncoding::kRgba8 : encoding;
}

auto contentOf(const PlaneFormat& format) {
  const auto& [kind, encoding, size_px, stride_bytes, compression, transfer, primaries, alpha,
               depth, normal_space, wire_bytes] = format;
  return std::tuple(kind, decodedEncoding(encoding), size_px, transfer, primaries, alpha,
                    contentOf(depth), normal_space);
}

bool haveSameContent(const LayerFormat& one, const LayerFormat& other) {
  const auto& [color, depth, depth_first, others, color_has_reflections] = one;
  // Other planes are compared in LayerPlanes::surface and motion.
  return contentOf(color) == contentOf(other.color) && contentOf(depth) == contentOf(other.depth) &&
         one.mirrors() == other.mirrors();
}

bool haveSameContent(const SourceFormat& one, const SourceFormat& other) {
  const auto& [camera, layers, connection_tolerance, is_cube_map] = one;
  const auto same_layer = [](const LayerFormat& a, const LayerFormat& b) {
    return haveSameContent(a, b);
  };
  return camera == other.camera && connection_tolerance == other.connection_tolerance &&
         is_cube_map == other.is_cube_map && std::ranges::equal(layers, other.layers, same_layer);
}

bool haveSameContent(const FrameFormat& one, const FrameFormat& other) {
  const auto& [number, capture_time_ns, sources, exposure_ev, tone_map] = one;
  const auto same_source = [](const SourceFormat& a, const SourceFormat& b) {
    return haveSameContent(a, b);
  };
  return exposure_ev == other.exposure_ev && tone_map == other.tone_map &&
         std::ranges::equal(sources, other.sources, same_source);
}

bool haveSameContent(const LayerPlanes& one, const LayerPlanes& other) {
  const auto& [color, color_encoding, depth, surface, bad_normals_count, motion,
               bad_motions_count] = one;
  const bool same_surface = surface == nullptr || *surface == *other.surface;
  const bool both_move = motion != nullptr && other.motion != nullptr;
  const bool same_motion = both_move ? *motion == *other.motion : motion == other.motion;
  return color_encoding == other.color_encoding && *depth == *other.depth &&
         *color == *other.color && same_surface && same_motion;
}

}  // namespace

bool haveSameContent(const Frame& one, const Frame& other) {
  if (!haveSameContent(one.format, other.format)) return false;
  // The formats agree, and so do the numbers of sources and layers.
  for (size_t s = 0; s < one.sources.size(); ++s) {
    for (size_t l = 0; l < one.sources[s].size(); ++l) {
      if (!haveSameContent(one.sources[s][l], other.sources[s][l])) return false;
    }
  }
  return true;
}

}  // namespace viewloom
