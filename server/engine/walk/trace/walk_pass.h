// SPDX-License-Identifier: Apache-2.0
// Walks rays through one structure.
#pragma once

#include <compare>

#include "gpu/commands.h"
#include "gpu/pass_map.h"
#include "trace/band_rays.h"
#include "trace/mean_color_pass.h"
#include "trace/trace_slot.h"

namespace viewloom {

// The device must outlive it. Thread-safety: all methods may be called from any thread.
class WalkPass {
 public:
  WalkPass(const Device& device, MeanColorPass& mean_color)
      : device_(device), mean_color_(mean_color), passes_(device, makePass) {}

  // Kernels that record() needs.
  void addMissing(const Walk& walk, MissingKernels& missing);

  // Rays of some px of the slot's band, which has these rows of the atlas. Where spans follow each
  // other, all px are walked once: invocations take runs of px, so that those at the ends may not
  // be the span's own. Of a list of blocks it is a share like that of the px in the band.
  struct Px {
    RowSpan rows;
    ColumnSpan columns;
  };
  // `target`: where they answer, at abi::kBindingBand. The structure's build is done, not only
  // recorded: its stats choose the kernel. Nothing is synchronised afterwards.
  void record(Commands commands, const Walk& walk, BandRows rows, const Px& px,
              const TraceSlot& slot, const Descriptor& target);
  // The same as MeanColorPass::recordRows, of the colour that the walk takes.
  uint64_t recordMeans(Commands commands, const Walk& walk, uint64_t texel_count_max);

 private:
  struct Variant {
    bool reads_by_address;
    uint32_t wanted;  // abi::kWant... flags
    uint32_t color_format;
    uint32_t pixels_per_invocation;
    bool lanes_are_views;
    bool color_is_scaled;
    bool rays_are_plain;
    bool eyes_in_plane;
    bool is_one_of_several;
    bool is_cube_face;
    uint32_t rays;          // abi::kRaysOf...
    uint32_t shown_beside;  // abi::kShows... flags that some tile has
    bool through_lens;
    bool is_of_blocks;
    bool lists_hidden;
    uint32_t rays_of_hidden;
    bool lists_unfinished;

    auto operator<=>(const Variant&) const = default;
  };

  static ComputePass makePass(const Device& device, const Variant& variant);
  Variant variantOf(const Walk& walk) const;
  static std::vector<Descriptor> describe(const Walk& walk, const Variant& variant,
                                          const LayeredBuffer& color, const TraceSlot& slot,
                                          const Descriptor& target);
  static void recordListed(Commands commands, const ComputePass& pass, const abi::TracePush& push,
                           const Walk& walk, BandRows rows, const Px& px, const TraceSlot& slot);

  const Device& device_;
  MeanColorPass& mean_color_;
  PassMap<Variant> passes_;
};

}  // namespace viewloom
