// SPDX-License-Identifier: Apache-2.0
#include "decode/frame_decoder.h"

#include <utility>

#include "base/check.h"
#include "base/str_cat.h"
#include "decode/keep_motion.h"
#include "decode/pack_surface.h"

namespace viewloom {
namespace {

// Takes the planes of one layer, of which `next` is the first, and goes on behind them.
absl::StatusOr<LayerPlanes> joinLayer(const LayerFormat& layer, const glm::dquat& world_from_camera,
                                      DecodedPlanes::iterator& next, BytePool& pool) {
  LayerPlanes joined;
  SurfacePlanes surface;
  for (size_t p = 0; p < 2 + layer.others.size(); ++p) {
    absl::StatusOr<SharedBytes>& plane = *next++;
    if (!plane.ok()) return withFieldPrefix(plane.status(), strCat("planes[", p, "]"));
    if (p >= 2 && layer.others[p - 2].kind == PlaneKind::kMotion) {
      keepMotion(*std::move(plane), pool, joined);
      continue;
    }
    if (p >= 2) {
      surface.of(layer.others[p - 2].kind) = *std::move(plane);
      continue;
    }
    const bool is_depth = (p == 0) == layer.depth_first;
    (is_depth ? joined.depth : joined.color) = *std::move(plane);
  }
  joined.color_encoding = layer.color.encoding == PlaneEncoding::kRgba16f ? PlaneEncoding::kRgba16f
                                                                          : PlaneEncoding::kRgba8;
  if (layer.mirrors()) addSurface(layer, surface, world_from_camera, pool, joined);
  return joined;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Frame>> joinPlanes(FrameFormat format, DecodedPlanes planes,
                                                  BytePool& pool) {
  auto frame = std::make_unique<Frame>();
  frame->format = std::move(format);
  VIEWLOOM_CHECK(planes.size() == wirePlanes(frame->format).size());
  auto next = planes.begin();
  for (size_t s = 0; s < frame->format.sources.size(); ++s) {
    const SourceFormat& source = frame->format.sources[s];
    std::vector<LayerPlanes>& joined = frame->sources.emplace_back();
    for (size_t l = 0; l < source.layers.size(); ++l) {
      absl::StatusOr<LayerPlanes> layer =
          joinLayer(source.layers[l], source.camera.pose.orientation, next, pool);
      if (!layer.ok()) {
        return withFieldPrefix(layer.status(), strCat("header.sources[", s, "].layers[", l, "]"));
      }
      joined.push_back(*std::move(layer));
    }
  }
  return frame;
}

absl::StatusOr<std::unique_ptr<Frame>> FrameDecoder::decode(CollectedFrame collected) {
  DecodedPlanes decoded;
  auto wire = collected.planes.begin();
  for (const PlaneFormat* plane : wirePlanes(collected.format)) {
    decoded.push_back(planes_.decode(*plane, std::move(*wire++)));
  }
  return joinPlanes(std::move(collected.format), std::move(decoded), pool_);
}

}  // namespace viewloom
