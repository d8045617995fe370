// SPDX-License-Identifier: Apache-2.0
// Which views of a display look past the image of their source, and how far.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "display/atlas_layout.h"
#include "display/source_demand.h"

namespace viewloom {

// As proto viewloom.v1.ViewsOutside.
struct ViewsOutside {
  uint32_t first_view = 0;
  uint32_t last_view = 0;
  double share = 0;  // of the worst of them, (0, 1]

  bool operator==(const ViewsOutside&) const = default;
};

// What is less past the image than this, px of the source, is not: the middles of the outermost px
// lie so far within it, and it continues as they are.
inline constexpr double kOutsideTolerance_px = 0.5;

// Of each view, how far it looks past a pinhole's image on its worst side, as a share of the
// image's width or height: of what lies at the far or the near end of the range, whichever shows
// more. Up to 1; 0 or less: not at all, and so far within. Panels whose subpixels have eyes of
// their own, and those behind microlenses, have one view, which here stands for all their eyes.
std::vector<double> outsideShares(const AtlasLayout& layout, const Pose& source_from_display,
                                  const Intrinsics& source, SizePx source_px,
                                  const InvZRange& range);

// Neighbouring views that look past it, from the first to the last.
std::vector<ViewsOutside> viewsOutside(std::span<const double> shares);

// Shares in whole hundredths, rounded up, that stay while depth merely trembles: a hundredth is
// left for the next where it is exceeded by more than kTremble or undercut by more than it.
// Thread-safety: none; one owner.
class SettledShares {
 public:
  static constexpr double kTremble = 0.005;

  // Those of the same views of the same source as before, but for their depth.
  std::vector<ViewsOutside> settle(std::span<const double> shares);

 private:
  std::vector<double> settled_;
};

}  // namespace viewloom
