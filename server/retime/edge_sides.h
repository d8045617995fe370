// SPDX-License-Identifier: Apache-2.0
// Colours of the surfaces on both sides of an edge, from the frame.
#pragma once

#include <cstdint>
#include <optional>

#include "retime/color_plane.h"
#include "retime/moved_surfaces.h"

namespace viewloom {

struct PxStep {
  int x = 0;
  int y = 0;
};

// The light on both sides of an edge, as it is in the middle between them.
struct EdgeSides {
  Texel far{};
  Texel between{};  // from there to the near side's
};

// Looks along rows and columns of the first layer, of which `color` is. Thread-safety: immutable.
class EdgeSurroundings {
 public:
  EdgeSurroundings(const MovedSurfaces& surfaces, const ColorPlane& color)
      : surfaces_(surfaces), color_(color), size_px_(surfaces.sizePx()) {}

  std::optional<uint32_t> beside(uint32_t px, PxStep step) const;
  // Two surfaces that go different ways.
  bool isEdge(uint32_t px, uint32_t other) const;
  // Sides of an edge between two pixels, with `step` from the near one to the far one. A thing one
  // pixel wide shows its own light.
  EdgeSides sidesOf(uint32_t near_px, uint32_t far_px, PxStep step) const;

 private:
  Texel farLight(uint32_t near_px, uint32_t far_px, PxStep step) const;
  Texel lightTowards(uint32_t px, PxStep step) const;

  const MovedSurfaces& surfaces_;
  const ColorPlane& color_;
  const SizePx size_px_;
};

}  // namespace viewloom
