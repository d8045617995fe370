// SPDX-License-Identifier: Apache-2.0
// The surfaces that rays of a block of px may meet, as few planes (shaders/lens.md).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <glm/vec2.hpp>

#include "lens/beam.h"
#include "lens/cells.h"
#include "lens/host_structure.h"
#include "shared/lens_abi.h"
#include "shared/sheet_reach.h"
#include "shared/trace_abi.h"

namespace viewloom {

// Thread-safety: none.
class SheetList {
 public:
  // Finds the sheets that rays of the pixels [low, high) of a tile may meet. All rays go where the
  // source looks.
  void find(const HostStructure& structure, const abi::ViewParams& view, glm::vec2 low_px,
            glm::vec2 high_px);

  // In the order in which they were found.
  std::span<const abi::MetSheet> sheets() const { return {sheets_.data(), count_}; }
  // Some rays pass beyond the image.
  bool mayLeave() const { return may_leave_; }
  // Every ray meets the first sheet, and nothing before it.
  bool isSettled() const { return is_settled_; }

 private:
  struct PlanePart;
  struct Search;

  void findAll(Search& search, float inv_z_near);
  void findIn(const Search& search, uint32_t layer);
  void findPlane(const Search& search, uint32_t layer, const CellAt& at, const SurfaceCell& cell,
                 RectPx met);
  void findFacets(const Search& search, uint32_t layer, const RectPx& met);
  bool isEverywhere(Search& search, float inv_z_near) const;
  bool hasOnlyKnown(const Search& search, const RectPx& part) const;
  bool isKnown(uint32_t layer, const PlanePart& part) const;
  void add(uint32_t layer, const PlanePart& part);
  // 1/m: of surfaces that lie there.
  float reachOver(glm::vec2 range_inv_z) const {
    return scale_ * abi::leastReach(reach_, range_inv_z.x, range_inv_z.y);
  }

  std::array<abi::MetSheet, 32> sheets_;
  uint32_t count_ = 0;
  abi::SheetReach reach_{};
  float scale_ = 1;  // of the reach
  bool is_too_many_ = false;
  bool may_leave_ = false;
  bool is_settled_ = false;
};

}  // namespace viewloom
