// SPDX-License-Identifier: Apache-2.0
// Finds the views of a display that look past the image of their source, and how far.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "display/atlas_layout.h"
#include "display/source_demand.h"

namespace viewloom {

// See proto viewloom.v1.ViewsOutside.
struct ViewsOutside {
  uint32_t first_view = 0;
  uint32_t last_view = 0;
  double share = 0;  // share of the worst view, (0, 1]

  bool operator==(const ViewsOutside&) const = default;
};

// Distance past the image that is ignored, px of the source. The middles of the outermost pixels
// lie so far within the image, and it continues with their values.
inline constexpr double kOutsideTolerance_px = 0.5;

// Share of the image's width or height by which each view looks past a pinhole's image on its worst
// side. It is taken at the far or the near end of the range, whichever gives more. At most 1; 0 or
// less means that the view stays within the image by that share. Lenticular panels and panels
// behind microlenses have one view, which here stands for all their eyes.
std::vector<double> outsideShares(const AtlasLayout& layout, const Pose& source_from_display,
                                  const Intrinsics& source, SizePx source_px,
                                  const InvZRange& range);

// Runs of neighbouring views that look past the image, from first to last.
std::vector<ViewsOutside> viewsOutside(std::span<const double> shares);

// Shares in whole hundredths, rounded up, that stay the same while depth merely fluctuates. A share
// changes to the next hundredth only if it is off by more than kTremble. Thread-safety: none; one
// owner.
class SettledShares {
 public:
  static constexpr double kTremble = 0.005;

  // Settles the shares. Only depth may have changed since the last call, not views or source.
  std::vector<ViewsOutside> settle(std::span<const double> shares);

 private:
  std::vector<double> settled_;
};

}  // namespace viewloom
