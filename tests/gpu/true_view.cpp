// SPDX-License-Identifier: Apache-2.0
#include "gpu/true_view.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>

#include "scoring/psnr.h"
#include "support/truth/known.h"

namespace viewloom {
namespace {

// Px whose neighbours, like themselves, see one body alone, and the same.
std::vector<uint8_t> insideSurfaces(const truth::PictureLayer& layer, SizePx size_px) {
  std::vector<uint8_t> is_inside(size_px.area());
  for (size_t y = 1; y + 1 < size_px.height; ++y) {
    for (size_t x = 1; x + 1 < size_px.width; ++x) {
      const uint32_t body = layer.body[y * size_px.width + x];
      bool is_alike = true;
      for (size_t i = 0; i < 9; ++i) {
        const size_t px = (y + i / 3 - 1) * size_px.width + x + i % 3 - 1;
        is_alike = is_alike && layer.is_mixed[px] == 0 && layer.body[px] == body;
      }
      is_inside[y * size_px.width + x] = is_alike;
    }
  }
  return is_inside;
}

void add(const float* got, const float* truth, Psnr& psnr) {
  for (int c = 0; c < 3; ++c) psnr.add(double{got[c]} - double{truth[c]});
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const TrueScore& score) {
  return out << std::fixed << std::setprecision(2) << std::setw(6) << score.covered_db << " /"
             << std::setw(6) << score.full_db << " /" << std::setw(6) << score.hidden_db;
}

TrueView::TrueView(const truth::Instant& instant, const ViewOfSource& cameras)
    : known_(truth::knownFrom(instant, cameras.source, cameras.source_px, cameras.view,
                              cameras.view_px)) {
  for (const Camera& source : cameras.more_sources) {
    const std::vector<uint8_t> known =
        truth::knownFrom(instant, source, cameras.source_px, cameras.view, cameras.view_px);
    for (size_t i = 0; i < known_.size(); ++i) known_[i] = std::min(known_[i], known[i]);
  }
  const truth::Picture picture =
      truth::takePicture(instant, cameras.view, {.size_px = cameras.view_px});
  image_ = scored(picture);
  is_inside_ = insideSurfaces(picture.layers.front(), cameras.view_px);
}

TrueScore TrueView::score(const ScoredImage& got) const {
  return score(got, std::vector<uint8_t>(known_.size(), 1));
}

TrueScore TrueView::scoreInside(const ScoredImage& got) const {
  return score(got, is_inside_);
}

TrueScore TrueView::scoreInside(const ScoredImage& got,
                                const std::vector<uint8_t>& selected) const {
  std::vector<uint8_t> both = is_inside_;
  for (size_t i = 0; i < both.size(); ++i) both[i] = both[i] != 0 && selected[i] != 0;
  return score(got, both);
}

TrueScore TrueView::score(const ScoredImage& got, const std::vector<uint8_t>& selected) const {
  Psnr covered, full, hidden;
  for (size_t i = 0; i < known_.size(); ++i) {
    if (selected[i] == 0) continue;
    const float* const a = &got.rgb[3 * i];
    const float* const b = &image_.rgb[3 * i];
    add(a, b, full);
    if (known_[i] == 0) add(a, b, covered);
    if (known_[i] == 1 || known_[i] == 2) add(a, b, hidden);
  }
  return {covered.db(), full.db(), hidden.db()};
}

double TrueView::share(uint8_t known) const {
  return double(std::count(known_.begin(), known_.end(), known)) / double(known_.size());
}

ScoredImage meanView(const RenderedAtlas& atlas, uint32_t view, SizePx size_px, size_t fineness) {
  const TileOrigin origin = atlas.layout->tileOrigin(view);
  ScoredImage image{.size_px = size_px, .rgb = {}};
  for (size_t i = 0; i < 3 * size_px.area(); ++i) {
    const size_t x_px = origin.x_px + i / 3 % size_px.width * fineness;
    const size_t y_px = origin.y_px + i / 3 / size_px.width * fineness;
    double sum = 0;
    for (size_t j = 0; j < fineness * fineness; ++j) {
      const size_t px = (y_px + j / fineness) * atlas.layout->size_px.width + x_px + j % fineness;
      sum += linearFromSrgb(double{atlas.linear[4 * px + i % 3]});
    }
    image.rgb.push_back(float(srgbFromLinear(sum / double(fineness * fineness))));
  }
  return image;
}

ScoredImage scored(const truth::Picture& picture) {
  ScoredImage image{.size_px = picture.size_px, .rgb = {}};
  for (const glm::vec3& color : picture.layers.front().color) {
    for (int c = 0; c < 3; ++c) image.rgb.push_back(float(srgbFromLinear(double{color[c]})));
  }
  return image;
}

}  // namespace viewloom
