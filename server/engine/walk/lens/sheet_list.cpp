// SPDX-License-Identifier: Apache-2.0
#include "lens/sheet_list.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace viewloom {
namespace {

bool isEmpty(const RectPx& rect) {
  return !(rect.low.x < rect.high.x && rect.low.y < rect.high.y);
}

bool isWithin(const RectPx& rect, const RectPx& other) {
  return glm::all(glm::greaterThanEqual(rect.low, other.low)) &&
         glm::all(glm::lessThanEqual(rect.high, other.high));
}

RectPx common(const RectPx& a, const RectPx& b) {
  return {glm::max(a.low, b.low), glm::min(a.high, b.high)};
}

// Rounds of a search. If the sheets do not suffice, the next round doubles the reach. Few rounds
// are needed even for a scene of which no two pixels lie in a plane: at 2^12 times an eighth of a
// pixel, blocks see single sheets.
constexpr int kRoundsMax = 12;

}  // namespace

// A rectangle of a plane.
struct SheetList::PlanePart {
  PlanePart(const CellAt& cell_at, const SurfaceCell& cell, const RectPx& rect)
      : at(0.5F * (rect.low + rect.high)),
        half_size(0.5F * (rect.high - rect.low)),
        inv_z(cell.at(at - cell_at.center())),
        slope(cell.slope),
        error(cell.error) {}
  // Plane part of a single facet.
  PlanePart(const CellAt& cell_at, const SurfaceCell& facet)
      : at(cell_at.center()), inv_z(facet.inv_z), slope(facet.slope) {}

  glm::vec2 range() const {
    const float half_range = glm::dot(glm::abs(slope), half_size);
    return {inv_z - half_range, inv_z + half_range};
  }

  glm::vec2 at;  // the middle, px
  glm::vec2 half_size{0};
  float inv_z;
  glm::vec2 slope;
  float error = 0;  // no facet of it is further away
};

// State of one search.
struct SheetList::Search {
  const HostStructure& structure;
  const Beam& beam;
  const RectPx image;
  glm::uvec2 first_root{0}, last_root{0};  // cells of the last level

  // Where rays may be within a cell, while 1/Z is in its range; beyond the image, its border
  // counts.
  RectPx metWithin(const RectPx& cell, float least_inv_z, float largest_inv_z) const {
    RectPx rect = beam.rectOver(std::max(least_inv_z, 0.0F), std::max(largest_inv_z, 0.0F));
    rect.low = glm::min(rect.low, image.high - 1.0F);
    rect.high = glm::max(rect.high, glm::vec2(1));
    return common(common(rect, cell), image);
  }

  // The search is among the nodes of a part of the image, or those at its border.
  void aimAt(const RectPx& part) {
    const auto rootAt = [&](glm::vec2 place) {
      return glm::uvec2(glm::clamp(place, glm::vec2(0), image.high - 1.0F)) >> abi::kLevelLast;
    };
    first_root = rootAt(part.low);
    last_root = rootAt(part.high);
  }

  // The next node that is not below this one. False: there is none.
  bool next(CellAt& at) const {
    while (at.level != abi::kLevelLast) {
      if ((at.cell.x & 1) == 0) return ++at.cell.x, true;
      at.cell.x &= ~1U;
      if ((at.cell.y & 1) == 0) return ++at.cell.y, true;
      at = {at.level + 1, at.cell >> 1U};
    }
    if (++at.cell.x > last_root.x) at.cell = {first_root.x, at.cell.y + 1};
    return at.cell.y <= last_root.y;
  }

  // Whether the layer before has the same surface there.
  bool isOfLayerBefore(uint32_t layer, const CellAt& at, const PlanePart& part) const {
    if (layer == 0) return false;
    const SurfaceCell front = surfaceCell(structure, layer - 1, at.level, at.cell);
    const float inv_z = front.at(part.at - at.center());
    return front.is_plane && inv_z - part.inv_z <= structure.kappa.at(inv_z);
  }
};

bool SheetList::isKnown(uint32_t layer, const PlanePart& part) const {
  return std::any_of(sheets_.begin(), sheets_.begin() + count_, [&](const abi::MetSheet& sheet) {
    const glm::vec2 off_slope = glm::abs(glm::vec2(sheet.plane) - part.slope);
    const float off = std::abs(glm::dot(sheet.plane, glm::vec3(part.at, 1)) - part.inv_z);
    const float off_most = off + glm::dot(off_slope, part.half_size);
    return sheet.layer == layer && std::max(off_most, part.error) <= sheet.reach;
  });
}

void SheetList::add(uint32_t layer, const PlanePart& part) {
  if (count_ == sheets_.size()) {
    is_too_many_ = true;
    return;
  }
  sheets_[count_++] = {.plane = {part.slope, part.inv_z - glm::dot(part.slope, part.at)},
                       .layer = layer,
                       .reach = reachOver(part.range())};
}

// Finds the part of a plane there that rays may meet.
void SheetList::findPlane(const Search& search, uint32_t layer, const CellAt& at,
                          const SurfaceCell& cell, RectPx met) {
  const PlanePart whole(at, cell, met);
  const float half_range = glm::dot(glm::abs(cell.slope), whole.half_size) + cell.error;
  met = search.metWithin(met, whole.inv_z - half_range, whole.inv_z + half_range);
  if (isEmpty(met)) return;
  const PlanePart part(at, cell, met);
  if (isKnown(layer, part) || search.isOfLayerBefore(layer, at, part)) return;
  add(layer, part);
}

// Facets lie alone where their node is no plane: their slopes tell little, so they face the source.
void SheetList::findFacets(const Search& search, uint32_t layer, const RectPx& met) {
  const glm::uvec2 first(met.low);
  const glm::uvec2 end(glm::ceil(met.high));
  for (uint32_t y = first.y; y < end.y && !is_too_many_; ++y) {
    for (uint32_t x = first.x; x < end.x; ++x) {
      const CellAt at{abi::kLevelFacets, {x, y}};
      const SurfaceCell facet = surfaceCell(search.structure, layer, at.level, at.cell);
      if (!facet.is_plane) continue;
      const PlanePart part(at, facet);
      if (isKnown(layer, part)) continue;
      if (isEmpty(search.metWithin(at.rect(), facet.range.x, facet.range.y))) continue;
      if (search.isOfLayerBefore(layer, at, part)) continue;
      add(layer, part);
    }
  }
}

// Nodes that no ray may meet are passed over, planes whose facets are all within reach become
// sheets, and others are looked into, as boxes are.
void SheetList::findIn(const Search& search, uint32_t layer) {
  CellAt at{abi::kLevelLast, search.first_root};
  do {
    for (;;) {
      const SurfaceCell cell = surfaceCell(search.structure, layer, at.level, at.cell);
      const RectPx met = search.metWithin(at.rect(), cell.range.x, cell.range.y);
      if (isEmpty(met) || cell.range.y < 0) break;
      if (cell.is_plane && cell.error <= reachOver(cell.range))
        findPlane(search, layer, at, cell, met);
      else if (at.level == abi::kLevelFirst)
        findFacets(search, layer, met);
      else {
        at = {at.level - 1, at.cell << 1U};
        continue;
      }
      break;
    }
  } while (!is_too_many_ && search.next(at));
}

// Whether all that the first layer has where rays meet the first sheet is that sheet.
bool SheetList::isEverywhere(Search& search, float inv_z_near) const {
  const auto& [plane, layer, reach] = sheets_.front();
  RectPx met = search.beam.rectOver(0, inv_z_near);
  // Where rays meet it tells the range of its 1/Z, and that where rays meet it.
  for (int round = 0; round < 2; ++round) {
    const glm::vec2 middle = 0.5F * (met.low + met.high);
    const float inv_z = glm::dot(plane, glm::vec3(middle, 1));
    const float half_range = glm::dot(glm::abs(glm::vec2(plane)), met.high - middle) + reach;
    met = search.beam.rectOver(std::max(inv_z - half_range, 0.0F),
                               std::max(inv_z + half_range, 0.0F));
  }
  if (!isWithin(met, search.image)) return false;
  search.aimAt(met);
  CellAt at{abi::kLevelLast, search.first_root};
  do {
    for (;;) {
      const RectPx part = common(at.rect(), met);
      if (isEmpty(part)) break;
      const SurfaceCell cell = surfaceCell(search.structure, 0, at.level, at.cell);
      if (cell.is_plane && cell.error <= reach) {
        if (!isKnown(0, PlanePart(at, cell, part))) return false;
        break;
      }
      if (cell.range.y < 0) return false;
      if (at.level == abi::kLevelFirst) {
        if (!hasOnlyKnown(search, part)) return false;
        break;
      }
      at = {at.level - 1, at.cell << 1U};
    }
  } while (search.next(at));
  return true;
}

bool SheetList::hasOnlyKnown(const Search& search, const RectPx& part) const {
  const glm::uvec2 first(part.low);
  const glm::uvec2 end(glm::ceil(part.high));
  for (uint32_t y = first.y; y < end.y; ++y) {
    for (uint32_t x = first.x; x < end.x; ++x) {
      const CellAt at{abi::kLevelFacets, {x, y}};
      const SurfaceCell facet = surfaceCell(search.structure, 0, at.level, at.cell);
      if (!facet.is_plane || !isKnown(0, PlanePart(at, facet))) return false;
    }
  }
  return true;
}

void SheetList::find(const HostStructure& structure, const abi::ViewParams& view, glm::vec2 low_px,
                     glm::vec2 high_px) {
  const float inv_z_near = std::max(structure.inv_z_max, abi::kInvZNearMin) * abi::kInvZNearMargin;
  const Beam beam(view, low_px, high_px, inv_z_near);
  const glm::vec2 size_px(structure.size_px.width, structure.size_px.height);
  Search search{structure, beam, {glm::vec2(0), size_px}};
  // It changes little from pixel to pixel, so the middle, far away, stands for all.
  const RectPx far = beam.rectOver(0, 0);
  const glm::vec2 middle_px = 0.5F * (low_px + high_px);
  const glm::vec3 direction =
      view.direction + middle_px.x * view.direction_dx + middle_px.y * view.direction_dy;
  reach_ = abi::sheetReach(view, 0.5F * (far.low + far.high), direction.z);
  const RectPx whole = beam.rectOver(0, inv_z_near);
  may_leave_ = !isWithin(whole, search.image);
  search.aimAt(whole);
  scale_ = 1;
  for (int round = 0; round < kRoundsMax; ++round, scale_ *= 2) {
    findAll(search, inv_z_near);
    if (!is_too_many_) break;
  }
}

void SheetList::findAll(Search& search, float inv_z_near) {
  count_ = 0;
  is_too_many_ = false;
  is_settled_ = false;
  for (uint32_t layer = 0; layer < search.structure.layer_count && !is_too_many_; ++layer) {
    findIn(search, layer);
    // Nothing behind it is seen.
    is_settled_ = layer == 0 && count_ == 1 && isEverywhere(search, inv_z_near);
    if (is_settled_) return;
  }
}

}  // namespace viewloom
