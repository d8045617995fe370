// SPDX-License-Identifier: Apache-2.0
#include "fidelity/rivals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "base/check.h"
#include "support/line_map.h"

namespace viewloom::fidelity {
namespace {

using Indices = std::span<const size_t>;

// visit(indices of a line's pixels, disparity along it, what places of it the view sees).
template <typename Visit>
void forEachMappedLine(const test::DataSet& set, const test::TrueView& view, double cut_px,
                       Visit visit) {
  const double steps = view.columns != 0 ? view.columns : view.rows;
  VIEWLOOM_CHECK(view.columns == 0 || view.rows == 0 ||
                 std::abs(view.columns) == std::abs(view.rows));
  std::vector<float> disparity_px;
  test::forEachLine(set.size_px, view.columns, view.rows, [&](Indices indices) {
    disparity_px.clear();
    for (const size_t i : indices) disparity_px.push_back(set.disparity_px[i]);
    visit(indices, std::span<const float>(disparity_px),
          test::mapLine(disparity_px, {.steps = steps, .cut_px = cut_px}));
  });
}

// Gives pixels that see nothing the next place of the line that is seen, on the farther side.
void fillFromFarSide(std::span<const float> disparity_px, std::vector<double>& places) {
  const auto isSeen = [](double place) { return !std::isnan(place); };
  for (auto hole = places.begin();;) {
    hole = std::find_if_not(hole, places.end(), isSeen);
    const auto end = std::find_if(hole, places.end(), isSeen);
    if (hole == places.begin() && end == places.end()) return;  // all is a hole, or there is none
    if (hole == places.end()) return;
    const bool takes_right = hole == places.begin() ||
                             (end != places.end() && test::valueAt(disparity_px, *end) <
                                                         test::valueAt(disparity_px, *(hole - 1)));
    std::fill(hole, end, takes_right ? *end : *(hole - 1));
    hole = end;
  }
}

}  // namespace

std::vector<Rival> rivalsOf(double mesh_cut_px) {
  return {{.name = "splat", .cut_px = -1},
          {.name = "sheet", .cut_px = std::numeric_limits<double>::infinity()},
          {.name = "cut mesh", .cut_px = mesh_cut_px}};
}

ScoredImage rivalView(const ScoredImage& source, const test::DataSet& set,
                      const test::TrueView& view, const Rival& rival) {
  ScoredImage image = {.size_px = set.size_px, .rgb = std::vector<float>(source.rgb.size(), 0)};
  std::vector<float> line;
  forEachMappedLine(
      set, view, rival.cut_px,
      [&](Indices indices, std::span<const float> disparity_px, std::vector<double> places) {
        fillFromFarSide(disparity_px, places);
        for (size_t c = 0; c < 3; ++c) {
          line.clear();
          for (const size_t i : indices) line.push_back(source.rgb[3 * i + c]);
          for (size_t i = 0; i < indices.size(); ++i) {
            if (std::isnan(places[i])) continue;
            image.rgb[3 * indices[i] + c] = static_cast<float>(test::valueAt(line, places[i]));
          }
        }
      });
  return image;
}

std::vector<PixelClass> classesOf(const test::DataSet& set, const test::TrueView& view,
                                  double cut_px) {
  std::vector<PixelClass> classes(set.size_px.area(), PixelClass::kOutside);
  forEachMappedLine(
      set, view, cut_px,
      [&](Indices indices, std::span<const float>, const std::vector<double>& places) {
        const auto isSeen = [](double place) { return !std::isnan(place); };
        const auto first = std::find_if(places.begin(), places.end(), isSeen);
        const auto last = std::find_if(places.rbegin(), places.rend(), isSeen);
        for (auto place = first; place < last.base(); ++place) {
          classes[indices[size_t(place - places.begin())]] =
              isSeen(*place) ? PixelClass::kCovered : PixelClass::kHidden;
        }
      });
  return classes;
}

}  // namespace viewloom::fidelity
