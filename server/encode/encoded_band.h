// SPDX-License-Identifier: Apache-2.0
// Output of the encoders: bands, and the atlas they make. Immutable, shared by all viewers.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/byte_pool.h"
#include "base/trace_method.h"
#include "display/atlas_layout.h"
#include "display/depth_budget.h"
#include "display/taken_defaults.h"
#include "display/views_outside.h"
#include "frame/stage_times.h"
#include "frame/timing.h"

namespace viewloom {

// kRed, kGreen and kBlue: channels of colour that are images of their own. kDepthCodes: depth in 16
// bits, as AtlasLayout::depth_codes says.
enum class AtlasPlane : uint8_t { kColor, kRed, kGreen, kBlue, kDepth, kMask, kDepthCodes };

inline bool isColor(AtlasPlane plane) {
  return plane < AtlasPlane::kDepth;
}

inline constexpr std::array kColorPlane = {AtlasPlane::kColor};
inline constexpr std::array kChannelPlanes = {AtlasPlane::kRed, AtlasPlane::kGreen,
                                              AtlasPlane::kBlue};

// Planes that carry the colour.
inline std::span<const AtlasPlane> colorPlanes(const EncodingSpec& encoding) {
  if (encoding.color == BandEncoding::kJpegPlanes) return kChannelPlanes;
  return kColorPlane;
}

// All planes of an atlas, in the order of their bands.
inline std::vector<AtlasPlane> planesOf(const EncodingSpec& encoding) {
  const std::span<const AtlasPlane> color = colorPlanes(encoding);
  std::vector<AtlasPlane> planes(color.begin(), color.end());
  if (encoding.with_depth) planes.push_back(AtlasPlane::kDepth);
  if (encoding.with_mask) planes.push_back(AtlasPlane::kMask);
  if (encoding.with_depth_codes) planes.push_back(AtlasPlane::kDepthCodes);
  return planes;
}

// Values of the mask plane; those of proto RayClass.
enum class RayClass : uint8_t { kPadding, kHit, kHitAssumed, kHidden, kOutside, kEmpty };

struct EncodedBand {
  uint32_t image_index = 0;
  AtlasPlane plane = AtlasPlane::kColor;
  uint32_t first_row = 0;
  uint32_t row_count = 0;
  BandEncoding encoding = BandEncoding::kJpeg;
  SharedBytes bytes;
};

// Facts about an atlas that are known only after its last band.
struct AtlasOutcome {
  StageTimes times;
  Coverage coverage;
  ReflectionCounts reflections;  // of displays with reflections
};

// A whole atlas: every band is there. Bands are sorted by plane, by place of the image in the order
// of the pictures, and by first_row.
struct EncodedAtlas : AtlasOutcome {
  uint64_t display_id = 0;
  uint64_t sequence = 0;  // of its display and encoding, from 1
  // Atlas of the display that its pictures refer to; 0 = it needs no other.
  uint64_t reference_sequence = 0;
  PictureOrder picture_order = PictureOrder::kForward;  // of the images
  uint64_t frame_number = 0;
  int64_t capture_time_ns = 0;
  int64_t present_at_ns = 0;
  int64_t shown_time_ns = 0;  // the publisher's clock; capture_time_ns without a TemporalSpec
  Timing timing = Timing::kCaptured;
  int64_t eye_poses_time_ns = 0;  // of a tracked display, the client's clock; 0 = none came yet
  int64_t predicted_display_time_ns = 0;
  int64_t eye_poses_latched_ns = 0;  // the server's monotonic clock
  int64_t eye_poses_age_ns = 0;      // by then
  Camera source_camera;
  Pose display_pose;
  std::shared_ptr<const AtlasLayout> layout;
  EncodingSpec encoding;
  uint32_t video_qp = 0;  // quantisation of H.264, which its display may leave to the server
  TraceMethod method = TraceMethod::kWalk;
  SourceStats stats;
  DefaultsTaking taking;                    // of the stream's defaults
  std::optional<DepthBudget> depth_budget;  // where views are neighbours
  std::vector<double> outside_shares;       // of each view; none of a cube map
  std::vector<EncodedBand> bands;

  // Bytes of the bands that are there.
  uint64_t byteCount() const {
    uint64_t count = 0;
    for (const EncodedBand& band : bands) count += band.bytes ? band.bytes->size() : 0;
    return count;
  }
};

using AtlasPtr = std::shared_ptr<const EncodedAtlas>;

}  // namespace viewloom
