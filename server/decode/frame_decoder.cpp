// SPDX-License-Identifier: Apache-2.0
#include "decode/frame_decoder.h"

#include <utility>

#include "base/check.h"
#include "base/str_cat.h"

namespace viewloom {

absl::StatusOr<std::unique_ptr<Frame>> joinPlanes(FrameFormat format, DecodedPlanes planes) {
  auto frame = std::make_unique<Frame>();
  frame->format = std::move(format);
  VIEWLOOM_CHECK(planes.size() == wirePlanes(frame->format).size());
  auto next = planes.begin();
  for (size_t s = 0; s < frame->format.sources.size(); ++s) {
    const std::vector<LayerFormat>& layers = frame->format.sources[s].layers;
    std::vector<LayerPlanes>& joined = frame->sources.emplace_back(layers.size());
    for (size_t l = 0; l < layers.size(); ++l) {
      for (const size_t p : {0U, 1U}) {
        absl::StatusOr<SharedBytes>& plane = *next++;
        if (!plane.ok()) {
          return withFieldPrefix(plane.status(),
                                 strCat("header.sources[", s, "].layers[", l, "].planes[", p, "]"));
        }
        const bool is_depth = (p == 0) == layers[l].depth_first;
        (is_depth ? joined[l].depth : joined[l].color) = *std::move(plane);
      }
      joined[l].color_encoding = layers[l].color.encoding == PlaneEncoding::kRgba16f
                                     ? PlaneEncoding::kRgba16f
                                     : PlaneEncoding::kRgba8;
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
  return joinPlanes(std::move(collected.format), std::move(decoded));
}

}  // namespace viewloom
