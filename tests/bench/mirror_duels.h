// SPDX-License-Identifier: Apache-2.0
// Reflected rays walked and marched, on the same frames, from the same px: their light beside the
// true one, and their time.
#pragma once

#include <string>
#include <vector>

#include "bench/gpu/dda_mirrors.h"
#include "bench/mirror_loads.h"
#include "gpu/device.h"

namespace viewloom::bench {

// A way to find what mirrors show.
struct MirrorPoint {
  std::string name;
  double time_ms = 0;  // of all reflected rays, without what adds their light to the px
  MirrorPsnr psnr;
};

// One view of one source of a scene.
struct MirrorDuel {
  std::string scene;
  std::string view;
  MirrorPsnr without;                // reflections
  std::vector<MirrorPoint> walks;    // by tolerance, the display's own first
  std::vector<MirrorPoint> marches;  // by knobs

  // The best march over all px of mirrors, in no more time than this, or at all.
  const MirrorPoint* bestMarch(double time_ms_max) const;
  const MirrorPoint& bestMarch() const;
  // The fastest of those that make more than this of all px; none where none does.
  const MirrorPoint* fastestMarch(double all_db_min) const;
};

// Duels with so many runs of each, in turn, for the medians.
std::vector<MirrorDuel> mirrorDuels(const Device& device, const MirrorScene& mirrors,
                                    uint32_t round_count);

}  // namespace viewloom::bench
