// SPDX-License-Identifier: Apache-2.0
#include "lens/gather_kernels.h"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lens/gather_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "lens/block_light_inl.h"
#include "lens/lens_rays_inl.h"
#include "sweep/vectors_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// Texels are fetched one by one, which is faster than gathers, and read as vectors long after.
HWY_INLINE void fetch(const uint32_t* HWY_RESTRICT from, const IntOfPx& indices,
                      OfPx<uint32_t>& to) {
  for (size_t p = 0; p < kBlockArea_px; ++p) to.at[p] = from[indices.at[p]];
}

void GatherOnSheet(const GatheredRays& rays, BlockLight& light) {
  const HostStructure& structure = rays.structure;
  const abi::MetSheet& sheet = rays.sheets.front();
  const Directions directions(rays);
  const Image image(structure.size_px);
  const uint32_t* const color = structure.color + size_t{sheet.layer} * structure.color_stride;
  IntOfPx indices;
  OfBlock is_met;
  OfPx<uint32_t> texels;
  for (const LensPoint& point : rays.points) {
    for (size_t p = 0; p < kBlockArea_px; p += hn::Lanes(kFloats)) {
      const Meeting at = meet(sheet.plane, lensRay(rays.view, directions, point, p), image);
      hn::Store(indexOf(at, structure.size_px.width), kInts, indices.at + p);
      const Mask counts = rays.fills_border ? at.is_met : at.is_inside;
      hn::Store(hn::IfThenElseZero(counts, set(1)), kFloats, is_met.data() + p);
    }
    fetch(color, indices, texels);
    for (size_t p = 0; p < kBlockArea_px; p += hn::Lanes(kFloats)) {
      const Vec count = loadPx(is_met, p);
      const Mask those = hn::Gt(count, hn::Zero(kFloats));
      add(light, p, lightOfThose(those, hn::Load(kWords, texels.at + p)), count);
    }
  }
}

// Where the rays of a point meet a sheet.
struct Meetings {
  OfBlock beside_x, beside_y;  // px beside the middle of the facet there
  OfBlock inv_z;               // of the sheet; NaN where it is not met
  OfBlock is_beyond;           // the image: 1, else 0; of rays that may leave it
  IntOfPx texels;              // of all layers
  IntOfPx facets;
};

// Nearest hits of the rays of a point so far.
struct Nearest {
  OfBlock inv_z;   // < 0: none of the surfaces
  IntOfPx texels;  // where, or as below
  IntOfPx sheets;  // a bit: which
};
constexpr int32_t kNothing = -1;
constexpr int32_t kBackground = -2;
// In place of 1/Z, so that any surface is nearer.
constexpr float kInvZOfNothing = -2;
constexpr float kInvZBeyond = -1;

HWY_INLINE void beginPoint(Nearest& nearest) {
  for (size_t p = 0; p < kBlockArea_px; p += hn::Lanes(kFloats)) {
    hn::Store(set(kInvZOfNothing), kFloats, nearest.inv_z.data() + p);
    hn::Store(hn::Set(kInts, kNothing), kInts, nearest.texels.at + p);
  }
}

// Whether a ray ends beyond the image: what it has not met by then, it leaves before.
HWY_INLINE Mask endsBeyond(const Point3& direction, const Image& image) {
  const Vec zero = hn::Zero(kFloats);
  const Mask is_low = hn::Or(hn::Lt(direction.x, zero), hn::Lt(direction.y, zero));
  const Mask is_high = hn::Or(hn::Gt(direction.x, hn::Mul(image.width, direction.z)),
                              hn::Gt(direction.y, hn::Mul(image.height, direction.z)));
  return hn::Or(is_low, is_high);
}

// Beyond the image a surface of its border goes on as the sheet has it.
HWY_INLINE void meetSheet(const GatheredRays& rays, const Image& image, const LensRays& lens_rays,
                          const abi::MetSheet& sheet, Meetings& met) {
  const HostStructure& structure = rays.structure;
  const IntVec first_texel = hn::Set(kInts, int32_t(sheet.layer * structure.color_stride));
  const Vec half = set(0.5F);
  for (size_t p = 0; p < kBlockArea_px; p += hn::Lanes(kFloats)) {
    const LensRay ray = lens_rays.at(p);
    const Meeting at = meet(sheet.plane, ray, image);
    hn::Store(hn::Sub(hn::Sub(at.x, at.column.first), half), kFloats, met.beside_x.data() + p);
    hn::Store(hn::Sub(hn::Sub(at.y, at.row.first), half), kFloats, met.beside_y.data() + p);
    const Vec inv_z = hn::MulAdd(set(sheet.plane.x), at.x,
                                 hn::MulAdd(set(sheet.plane.y), at.y, set(sheet.plane.z)));
    hn::Store(hn::IfThenElse(at.is_met, inv_z, hn::NaN(kFloats)), kFloats, met.inv_z.data() + p);
    hn::Store(indexOf(at, structure.padded_width), kInts, met.facets.at + p);
    IntVec texel = hn::Add(indexOf(at, structure.size_px.width), first_texel);
    if (rays.may_leave) {
      const Mask is_beyond = hn::AndNot(at.is_inside, at.is_met);
      hn::Store(hn::IfThenElseZero(is_beyond, set(1)), kFloats, met.is_beyond.data() + p);
      if (!rays.fills_border) {
        const Mask is_background = hn::And(is_beyond, endsBeyond(ray.direction, image));
        texel = hn::IfThenElse(hn::RebindMask(kInts, is_background), hn::Set(kInts, kBackground),
                               texel);
      }
    }
    hn::Store(texel, kInts, met.texels.at + p);
  }
}

// Compares the facets at the meetings with a sheet; facets within its reach count.
HWY_INLINE void compareFacets(const OfPx<uint64_t>& facets, const Meetings& met, float reach,
                              bool may_leave, int32_t sheet_bit, Nearest& nearest) {
  for (size_t p = 0; p < kBlockArea_px; p += hn::Lanes(kFloats)) {
    WordVec inv_z_bits;
    WordVec slope_bits;
    hn::LoadInterleaved2(kWords, reinterpret_cast<const uint32_t*>(facets.at + p), inv_z_bits,
                         slope_bits);
    const Vec slope_x = hn::BitCast(kFloats, hn::ShiftLeft<16>(slope_bits));
    const Vec slope_y = hn::BitCast(kFloats, hn::And(slope_bits, hn::Set(kWords, 0xffff0000U)));
    // No facet is no number, which nothing is near to.
    const Vec middle = hn::Abs(hn::BitCast(kFloats, inv_z_bits));
    const Vec leaning = hn::MulAdd(slope_x, loadPx(met.beside_x, p),
                                   hn::MulAdd(slope_y, loadPx(met.beside_y, p), middle));
    const Mask is_below = hn::Lt(leaning, hn::Zero(kFloats));
    const Vec facet = hn::IfThenElse(is_below, hn::Zero(kFloats), leaning);
    const Vec off = hn::Abs(hn::Sub(facet, loadPx(met.inv_z, p)));
    Vec inv_z = facet;
    if (may_leave) {
      const Mask is_beyond = hn::Gt(loadPx(met.is_beyond, p), hn::Zero(kFloats));
      inv_z = hn::IfThenElse(is_beyond, set(kInvZBeyond), facet);
    }
    const Vec before = loadPx(nearest.inv_z, p);
    const Mask holds = hn::And(hn::Le(off, set(reach)), hn::Gt(inv_z, before));
    hn::Store(hn::IfThenElse(holds, inv_z, before), kFloats, nearest.inv_z.data() + p);
    const auto take = [&](IntVec value, IntOfPx& of_px) {
      const IntVec known = hn::Load(kInts, of_px.at + p);
      hn::Store(hn::IfThenElse(hn::RebindMask(kInts, holds), value, known), kInts, of_px.at + p);
    };
    take(hn::Load(kInts, met.texels.at + p), nearest.texels);
    take(hn::Set(kInts, sheet_bit), nearest.sheets);
  }
}

// Hits of the rays of any point, by lanes.
struct MetWords {
  WordVec sheets;  // bits of those that were met
  WordVec none;  // all bits where one met none within the image, or at its border, if that goes on
};

HWY_INLINE void noteMet(const GatheredRays& rays, const Nearest& nearest, size_t p, MetWords& met) {
  const Vec inv_z = loadPx(nearest.inv_z, p);
  const auto isFrom = [&](float least) {
    return hn::RebindMask(kWords, hn::Ge(inv_z, set(least)));
  };
  const WordVec bit = hn::Load(kWords, reinterpret_cast<const uint32_t*>(nearest.sheets.at) + p);
  met.sheets = hn::Or(met.sheets, hn::IfThenElseZero(isFrom(kInvZBeyond), bit));
  const auto is_met = isFrom(rays.fills_border ? kInvZBeyond : 0.0F);
  met.none = hn::Or(met.none, hn::VecFromMask(kWords, hn::Not(is_met)));
}

// Adds the light of what the rays of a point met.
HWY_INLINE void addMet(const GatheredRays& rays, const Nearest& nearest,
                       const OfPx<uint32_t>& texels, BlockLight& light) {
  for (size_t p = 0; p < kBlockArea_px; p += hn::Lanes(kFloats)) {
    const IntVec place = hn::Load(kInts, nearest.texels.at + p);
    const auto is = [&](int32_t value) { return hn::Eq(place, hn::Set(kInts, value)); };
    const WordVec texel =
        hn::IfThenElse(hn::RebindMask(kWords, is(kBackground)), hn::Set(kWords, rays.background),
                       hn::Load(kWords, texels.at + p));
    const Mask is_met = hn::Not(hn::RebindMask(kFloats, is(kNothing)));
    add(light, p, lightOfThose(is_met, texel), hn::IfThenElseZero(is_met, set(1)));
  }
}

HWY_INLINE void noteOpen(const Nearest& nearest, uint32_t point, OfBlock& count,
                         std::vector<OpenRay>* open) {
  for (uint32_t p = 0; p < kBlockArea_px; ++p) {
    if (nearest.texels.at[p] != kNothing) continue;
    ++count[p];
    if (open) open->push_back({p, point});
  }
}

MetSheets GatherOnSheets(const GatheredRays& rays, BlockLight& light, std::vector<OpenRay>* open) {
  const HostStructure& structure = rays.structure;
  const Directions directions(rays);
  const Image image(structure.size_px);
  LensRays lens_rays;
  Meetings met;
  Nearest nearest;
  OfPx<uint64_t> facets;
  IntOfPx indices;
  OfPx<uint32_t> texels;
  MetWords met_words{hn::Zero(kWords), hn::Zero(kWords)};
  MetSheets result;
  for (uint32_t point = 0; point < rays.points.size(); ++point) {
    raysOf(rays.view, directions, rays.points[point], lens_rays);
    beginPoint(nearest);
    for (size_t i = 0; i < rays.sheets.size(); ++i) {
      const abi::MetSheet& sheet = rays.sheets[i];
      meetSheet(rays, image, lens_rays, sheet, met);
      const abi::uvec2* const from = structure.level(sheet.layer, abi::kLevelFacets);
      for (size_t p = 0; p < kBlockArea_px; ++p) {
        std::memcpy(facets.at + p, from + met.facets.at[p], sizeof(uint64_t));
      }
      // Facets beside those that a sheet stands for may lie as far off once more.
      compareFacets(facets, met, 2 * sheet.reach, rays.may_leave, int32_t(1U << i), nearest);
    }
    bool is_some_open = false;
    for (size_t p = 0; p < kBlockArea_px; p += hn::Lanes(kFloats)) {
      const IntVec texel = hn::Load(kInts, nearest.texels.at + p);
      hn::Store(hn::Max(texel, hn::Zero(kInts)), kInts, indices.at + p);
      is_some_open |= !hn::AllFalse(kInts, hn::Eq(texel, hn::Set(kInts, kNothing)));
      noteMet(rays, nearest, p, met_words);
    }
    fetch(structure.color, indices, texels);
    addMet(rays, nearest, texels, light);
    if (is_some_open) noteOpen(nearest, point, result.open_count, open);
  }
  for (size_t lane = 0; lane < hn::Lanes(kFloats); ++lane) {
    result.sheets |= hn::ExtractLane(met_words.sheets, lane);
    result.is_all &= hn::ExtractLane(met_words.none, lane) == 0;
  }
  return result;
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewloom {

HWY_EXPORT(GatherOnSheet);
HWY_EXPORT(GatherOnSheets);
HWY_EXPORT(MeanOf);

void gatherOnSheet(const GatheredRays& rays, BlockLight& light) {
  HWY_DYNAMIC_DISPATCH(GatherOnSheet)(rays, light);
}

MetSheets gatherOnSheets(const GatheredRays& rays, BlockLight& light, std::vector<OpenRay>* open) {
  return HWY_DYNAMIC_DISPATCH(GatherOnSheets)(rays, light, open);
}

void meanOf(const BlockLight& light, BlockCodes& codes) {
  HWY_DYNAMIC_DISPATCH(MeanOf)(light, codes);
}

}  // namespace viewloom
#endif
