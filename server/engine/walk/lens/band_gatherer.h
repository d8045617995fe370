// SPDX-License-Identifier: Apache-2.0
// A lens before the views of an atlas where device and CPU share memory: px are the mean of many
// rays, which meet what the structure holds around them (shaders/lens.md).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lens/gather_kernels.h"
#include "lens/host_structure.h"
#include "lens/sheet_list.h"
#include "picture/trace_job.h"
#include "trace/trace_slot.h"

namespace viewloom {

// Whether the CPU gathers the lens (TraceJob::gathers_on_host): the structure is in reach, the lens
// has a second stage whose rays are never walked, and all views look where the source looks.
bool gathersOnHost(bool is_in_reach, const TraceJob& job);

// Blocks in these rows of an atlas whose first px are in columns [first_column, end_column) of it.
struct GatheredPiece {
  BandRows rows;
  uint32_t first_column = 0;
  uint32_t end_column = 0;
};

// These rows of an atlas in pieces, each to be gathered at once. A piece has whole blocks where
// that can be, and about kGatheredRays or `ray_count_max` rays at most, whichever is less.
std::vector<GatheredPiece> gatheredPieces(const AtlasLayout& layout, BandRows rows,
                                          uint64_t ray_count_max);

// Rows of an atlas, of which a piece is gathered.
struct GatheredBand {
  GatheredPiece piece;
  std::span<uint32_t> color;  // uint32_t[rows][width]: R, G, B, 255 in memory order
  std::span<float> linear;    // float[rows][width][4], sRGB-encoded; empty where it is not wanted
};

// This piece of the atlas in the slot of a band of it, `first_row` rows below its first. The device
// is done with it.
GatheredBand bandOf(TraceSlot& slot, const AtlasLayout& layout, const GatheredPiece& piece,
                    uint32_t first_row);

// Keeps what a block needs on its way. Thread-safety: none; one a thread. Several may have pieces
// of one band.
class BandGatherer {
 public:
  // `band` holds what the middle rays of the px see, and gets what all see. The job gathers on the
  // host (TraceJob::gathers_on_host); the structure is that of its source.
  void gather(const HostStructure& structure, const TraceJob& job, const GatheredBand& band);

 private:
  struct Tile;

  void takePoints(const AtlasLayout& layout);
  void gatherRays(GatheredRays rays, uint32_t first_count);
  void guess(const GatheredRays& rays);
  void addGuesses(const OfBlock& open_count);
  void gatherBlock(const HostStructure& structure, const TraceJob& job, const Tile& tile,
                   glm::uvec2 block_px, const GatheredBand& band);

  std::vector<LensPoint> points_;
  SheetList list_;
  std::vector<abi::MetSheet> met_;              // of them, what rays have met
  std::array<uint32_t, kBlockArea_px> middle_;  // what the middle rays of the px see
  std::vector<OpenRay> open_;
  BlockLight guesses_;
  BlockLight light_;
  BlockCodes codes_;
};

}  // namespace viewloom
