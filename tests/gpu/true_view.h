// SPDX-License-Identifier: Apache-2.0
// The true picture from one view, how much of it a source can know, and what renderings of it are
// worth.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <vector>

#include "scoring/image_score.h"
#include "support/truth/picture.h"
#include "walk/offline_renderer.h"

namespace viewloom {

// PSNR in dB; NaN where there is no such px.
struct TrueScore {
  double covered_db = 0;  // of px that see what the first layer of some source holds
  double full_db = 0;     // of all
  double hidden_db = 0;   // of px that see what its second or third layer holds

  double gapDb() const { return covered_db - full_db; }
};

std::ostream& operator<<(std::ostream& out, const TrueScore& score);

struct ViewOfSource {
  Camera source;
  SizePx source_px;
  Camera view;
  SizePx view_px;
  std::vector<Camera> more_sources = {};  // of the same size
};

class TrueView {
 public:
  TrueView(const truth::Instant& instant, const ViewOfSource& cameras);

  TrueScore score(const ScoredImage& got) const;
  // Without the px beside an edge between two bodies, where a px more or less is what sampling
  // leaves open.
  TrueScore scoreInside(const ScoredImage& got) const;
  // Score over those of them that are also selected.
  TrueScore scoreInside(const ScoredImage& got, const std::vector<uint8_t>& selected) const;

  // Share of all px, by truth::Known.
  double share(uint8_t known) const;

 private:
  TrueScore score(const ScoredImage& got, const std::vector<uint8_t>& selected) const;

  std::vector<uint8_t> known_;
  ScoredImage image_;
  std::vector<uint8_t> is_inside_;
};

// A view that was traced so many times finer, of this size averaged over the px.
ScoredImage meanView(const RenderedAtlas& atlas, uint32_t view, SizePx size_px, size_t fineness);

// The first layer, sRGB-encoded.
ScoredImage scored(const truth::Picture& picture);

}  // namespace viewloom
