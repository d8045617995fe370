// SPDX-License-Identifier: Apache-2.0
// True pictures of the loads' scenes from anywhere, and how close a picture comes to them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bench/bench_load.h"

namespace viewloom::bench {

// Light at the centre of each px, as the frames hold it: textures end as sharply as there, even
// where a px of the view is larger than one of the source. Alpha is 0 where the source's image, of
// `source_px`, ends before it reaches the surface, else 255.
std::vector<uint32_t> trueClutter(const Camera& view, SizePx view_px, SizePx source_px);
std::vector<uint32_t> trueSmooth(const Camera& view, SizePx view_px, SizePx source_px);
std::vector<uint32_t> trueThin(const Camera& view, SizePx view_px, SizePx source_px);

// Places of a px, along each axis, of which a true px is the mean.
inline constexpr uint32_t kTruePlaces = 4;

// Colour of px with their area: the mean of the codes at kTruePlaces^2 places of each. Alpha is 0
// unless all of them are known.
std::vector<uint32_t> meanView(const TrueView& true_view, const Camera& view, SizePx view_px);

// The first, the middle and the last view of a load, as they truly are (meanView); none if that is
// unknown.
class TrueTiles {
 public:
  explicit TrueTiles(const BenchLoad& load);

  // Over all channels of the px of those views that see what the source's image reaches, whatever
  // hides it there; peak 255 codes. `atlas`: rgba[row][column]. None without truth or picture.
  std::optional<double> psnrDb(std::span<const uint32_t> atlas) const;

 private:
  struct Tile {
    uint32_t view = 0;
    std::vector<uint32_t> rgba;
  };

  const AtlasLayout& layout_;
  std::vector<Tile> tiles_;
};

}  // namespace viewloom::bench
