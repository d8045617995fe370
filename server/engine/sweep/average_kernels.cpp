// SPDX-License-Identifier: Apache-2.0
#include "sweep/average_kernels.h"

#include "frame/color_reach.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sweep/average_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sweep/packed_channels_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

constexpr Bytes kBytes;

HWY_INLINE IntVec loadBytes(const uint8_t* bytes, size_t x) {
  return hn::PromoteTo(kInts, hn::LoadU(kBytes, bytes + x));
}

HWY_INLINE Channels scaled(const Channels& channels, Vec by) {
  return {hn::Mul(channels.red, by), hn::Mul(channels.green, by), hn::Mul(channels.blue, by)};
}

HWY_INLINE void addScaled(Channels& sum, const Channels& channels, Vec by) {
  sum.red = hn::Add(sum.red, hn::Mul(by, channels.red));
  sum.green = hn::Add(sum.green, hn::Mul(by, channels.green));
  sum.blue = hn::Add(sum.blue, hn::Mul(by, channels.blue));
}

// Weights of texels where all of them count.
struct WholeWeights {
  explicit WholeWeights(const AverageRow& row) {
    float here = 1;
    float there = row.weight_there;
    for (const auto& side : row.taps) {
      for (const AverageTap& tap : side) {
        here += tap.weight_here;
        there += tap.weight_there;
      }
    }
    here_scale = (1 - row.share) / here;
    there_scale = there > 0 ? row.share / there : 0;
  }
  float of(float weight_here, float weight_there) const {
    return weight_here * here_scale + weight_there * there_scale;
  }

  float here_scale = 0;
  float there_scale = 0;
};

// Whether each px goes on along all taps in its own layer, and none of them is mixed: most do.
HWY_INLINE bool isWhole(const AverageRow& row, uint32_t layer, size_t x) {
  const auto own = hn::Set(kBytes, uint8_t(layer + 1));
  auto other = hn::LoadU(kBytes, row.is_mixed[layer] + x);
  for (const auto& side : row.taps) {
    for (const AverageTap& tap : side) {
      const auto link = hn::LoadU(kBytes, tap.links[layer] + x);
      other = hn::Or(other, hn::Or(hn::Xor(link, own), hn::LoadU(kBytes, tap.is_mixed[layer] + x)));
    }
  }
  return hn::AllTrue(kBytes, hn::Eq(other, hn::Zero(kBytes)));
}

HWY_INLINE WordVec wholeMean(const AverageRow& row, const WholeWeights& weights, uint32_t layer,
                             size_t x) {
  Channels sum = scaled(channelsOf<false>(hn::LoadU(kWords, row.color[layer] + x)),
                        set(weights.of(1, row.weight_there)));
  for (const auto& side : row.taps) {
    for (const AverageTap& tap : side) {
      addScaled(sum, channelsOf<false>(hn::LoadU(kWords, tap.color[layer] + x)),
                set(weights.of(tap.weight_here, tap.weight_there)));
    }
  }
  return packChannels(sum);
}

// The values of the layer that each px has come to.
template <uint32_t kLayers, typename V, typename Load>
HWY_INLINE V pick(IntVec layer, const Load& load) {
  V picked = load(0);
  for (uint32_t i = 1; i < kLayers; ++i) {
    const auto is_here = hn::Eq(layer, hn::Set(kInts, int32_t(i)));
    picked = hn::IfThenElse(hn::RebindMask(hn::DFromV<V>(), is_here), load(i), picked);
  }
  return picked;
}

struct WeightedSum {
  HWY_INLINE void add(const Channels& tap, Mask counts, float tap_weight) {
    const Vec share = hn::IfThenElseZero(counts, set(tap_weight));
    addScaled(channels, tap, share);
    weight = hn::Add(weight, share);
  }
  HWY_INLINE Channels mean() const { return scaled(channels, hn::Div(set(1), weight)); }

  Channels channels;
  Vec weight;
};

// Texels that may go on in any layer, or end.
template <uint32_t kLayers>
HWY_INLINE WordVec linkedMean(const AverageRow& row, uint32_t layer, size_t x) {
  const Channels own = channelsOf<false>(hn::LoadU(kWords, row.color[layer] + x));
  WeightedSum here{own, set(1)};
  WeightedSum there{scaled(own, hn::Zero(kFloats)), hn::Zero(kFloats)};
  const auto is_own_clean = hn::Eq(loadBytes(row.is_mixed[layer], x), hn::Zero(kInts));
  there.add(own, hn::RebindMask(kFloats, is_own_clean), row.weight_there);
  const IntVec no_link = hn::Set(kInts, int32_t(abi::kDeepEdge));
  auto has_there = hn::RebindMask(kInts, noLane());
  for (size_t side = 0; side < row.taps.size(); ++side) {
    IntVec at_layer = hn::Set(kInts, int32_t(layer));
    auto is_linked = hn::Eq(at_layer, at_layer);
    for (size_t k = 0; k < row.taps[side].size(); ++k) {
      const AverageTap& tap = row.taps[side][k];
      const IntVec link =
          pick<kLayers, IntVec>(at_layer, [&](uint32_t i) { return loadBytes(tap.links[i], x); });
      is_linked = hn::And(is_linked, hn::And(hn::Gt(link, hn::Zero(kInts)), hn::Lt(link, no_link)));
      if (side == 1 && k == 0) has_there = is_linked;
      at_layer = hn::IfThenElse(is_linked, hn::Sub(link, hn::Set(kInts, 1)), at_layer);
      const IntVec mixed = pick<kLayers, IntVec>(
          at_layer, [&](uint32_t i) { return loadBytes(tap.is_mixed[i], x); });
      const WordVec color = pick<kLayers, WordVec>(
          at_layer, [&](uint32_t i) { return hn::LoadU(kWords, tap.color[i] + x); });
      const Channels channels = channelsOf<false>(color);
      const auto is_clean = hn::Eq(mixed, hn::Zero(kInts));
      const Mask counts = hn::RebindMask(kFloats, hn::And(is_linked, is_clean));
      here.add(channels, counts, tap.weight_here);
      // A sample on the other row counts in any case.
      const bool is_its_own = side == 1 && k == 0;
      there.add(channels, is_its_own ? hn::RebindMask(kFloats, is_linked) : counts,
                tap.weight_there);
    }
  }
  const Vec share = hn::IfThenElseZero(hn::RebindMask(kFloats, has_there), set(row.share));
  Channels blend = scaled(here.mean(), hn::Sub(set(1), share));
  // Where nothing is linked there, its weight may be 0.
  there.weight = hn::Max(there.weight, set(1e-6F));
  addScaled(blend, there.mean(), share);
  return packChannels(blend);
}

template <uint32_t kLayers>
HWY_INLINE void averageLayers(const AverageRow& row) {
  const WholeWeights weights(row);
  for (size_t x = 0; x < row.width; x += hn::Lanes(kFloats)) {
    for (uint32_t i = 0; i < kLayers; ++i) {
      // Deeper layers are mostly empty.
      const Vec inv_z = loadAt(row.inv_z, i, x, 0);
      if (hn::AllFalse(kFloats, hn::Ge(inv_z, hn::Zero(kFloats)))) continue;
      const WordVec means = HWY_LIKELY(isWhole(row, i, x)) ? wholeMean(row, weights, i, x)
                                                           : linkedMean<kLayers>(row, i, x);
      hn::StoreU(means, kWords, row.means[i] + x);
    }
  }
}

void AverageTexelRow(const AverageRow& row) {
  VIEWLOOM_BY_LAYER_COUNT(row.layer_count, averageLayers, row)
}

void MarkMixed(const std::array<const uint8_t*, 4>& links, uint32_t width, uint8_t* is_mixed) {
  const auto deep = hn::Set(kBytes, abi::kDeepEdge);
  const auto isDeep = [&](const uint8_t* edge, size_t x) {
    return hn::VecFromMask(kBytes, hn::Eq(hn::LoadU(kBytes, edge + x), deep));
  };
  for (size_t x = 0; x < width; x += hn::Lanes(kBytes)) {
    hn::StoreU(hn::Or(hn::Or(isDeep(links[0], x), isDeep(links[1], x)),
                      hn::Or(isDeep(links[2], x), isDeep(links[3], x))),
               kBytes, is_mixed + x);
  }
}

// Mean of texels some of which reach beyond the ends.
HWY_INLINE WordVec meanAtEnd(const AverageChain& chain, size_t x) {
  WeightedSum sum{channelsOf<true>(hn::LoadU(kWords, chain.texels + x)), set(1)};
  const IntVec at = hn::Iota(kInts, int32_t(x));
  const IntVec before_first = hn::Set(kInts, chain.is_first_mixed ? 0 : -1);
  const IntVec end = hn::Set(kInts, int32_t(chain.count) - (chain.is_last_mixed ? 1 : 0));
  for (uint32_t k = 1; k <= tapCount(chain.reach_px); ++k) {
    for (const int32_t apart : {-int32_t(k), int32_t(k)}) {
      const IntVec tap = hn::Add(at, hn::Set(kInts, apart));
      const auto counts = hn::And(hn::Gt(tap, before_first), hn::Lt(tap, end));
      sum.add(channelsOf<true>(hn::LoadU(kWords, chain.texels + ptrdiff_t(x) + apart)),
              hn::RebindMask(kFloats, counts), tapWeight(chain.reach_px, k));
    }
  }
  return packChannels(sum.mean());
}

void AverageChainOf(const AverageChain& chain, uint32_t* means) {
  const size_t lanes = hn::Lanes(kFloats);
  const size_t tap_count = tapCount(chain.reach_px);
  float weight = 1;
  for (uint32_t k = 1; k <= tap_count; ++k) weight += 2 * tapWeight(chain.reach_px, k);
  const Vec scale = set(1 / weight);
  for (size_t x = 0; x < chain.count; x += lanes) {
    // One more, as the ends may be mixed.
    const bool is_inside = x > tap_count && x + lanes + tap_count < chain.count;
    if (!is_inside) {
      hn::StoreU(meanAtEnd(chain, x), kWords, means + x);
      continue;
    }
    Channels sum = channelsOf<true>(hn::LoadU(kWords, chain.texels + x));
    for (uint32_t k = 1; k <= tap_count; ++k) {
      const WordVec before = hn::LoadU(kWords, chain.texels + x - k);
      const WordVec after = hn::LoadU(kWords, chain.texels + x + k);
      addScaled(sum, channelsOfBoth(before, after), set(tapWeight(chain.reach_px, k)));
    }
    hn::StoreU(packChannels(scaled(sum, scale)), kWords, means + x);
  }
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewloom {

HWY_EXPORT(AverageTexelRow);
HWY_EXPORT(MarkMixed);
HWY_EXPORT(AverageChainOf);

void averageRow(const AverageRow& row) {
  HWY_DYNAMIC_DISPATCH(AverageTexelRow)(row);
}

void markMixed(const std::array<const uint8_t*, 4>& links, uint32_t width, uint8_t* is_mixed) {
  HWY_DYNAMIC_DISPATCH(MarkMixed)(links, width, is_mixed);
}

void averageChain(const AverageChain& chain, uint32_t* means) {
  HWY_DYNAMIC_DISPATCH(AverageChainOf)(chain, means);
}

}  // namespace viewloom
#endif
