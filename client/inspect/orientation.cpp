// SPDX-License-Identifier: Apache-2.0
#include "inspect/orientation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/str_cat.h"

namespace viewloom::inspect {
namespace {

constexpr float kStep = 0.1F;        // of 1/Z, from where on two cells are different surfaces
constexpr int kEdgeMin = 12;         // of the three channels together; less is noise
constexpr ptrdiff_t kSlack = 1;      // cells by which colour and depth may lie apart
constexpr ptrdiff_t kBeside = 6;     // cells on either side that an edge is compared with
constexpr uint64_t kStepsMin = 100;  // fewer tell nothing
constexpr double kAgrees = 0.5;  // what real pictures reach: 0.7; the same upside down: 0.15..0.25
constexpr double kDisagrees = 0.3;
constexpr double kClearly = 2;  // times

// Depth and colour, thinned out, on one grid.
class CoarseGrid {
 public:
  CoarseGrid(const DepthSamples& samples, const ColorPixels& color) {
    const uint32_t stride = samples.gridStride_px();
    width_ = samples.width_px / stride;
    height_ = samples.height_px / stride;
    for (ptrdiff_t row = 0; row < height_; ++row) {
      const uint32_t y = uint32_t(row) * stride + stride / 2;
      for (ptrdiff_t column = 0; column < width_; ++column) {
        const uint32_t x = uint32_t(column) * stride + stride / 2;
        inv_z_.push_back(samples.inv_z[size_t{y} * samples.width_px + x]);
        colors_.push_back(color.at((x + 0.5) / samples.width_px, (y + 0.5) / samples.height_px));
      }
    }
  }

  // Steps along one axis: `along_x` or down. The rows of depth count from below if `is_flipped`.
  struct Count {
    uint64_t steps = 0;
    uint64_t agreeing = 0;
  };
  Count count(bool along_x, bool is_flipped) const {
    Count count;
    const ptrdiff_t length = along_x ? width_ : height_;
    const ptrdiff_t lines = along_x ? height_ : width_;
    for (ptrdiff_t line = 0; line < lines; ++line) {
      for (ptrdiff_t i = kBeside; i + kBeside + 1 < length; ++i) {
        if (!isStep(cell(along_x, is_flipped, line, i), cell(along_x, is_flipped, line, i + 1))) {
          continue;
        }
        ++count.steps;
        if (isEdge(along_x, line, i)) ++count.agreeing;
      }
    }
    return count;
  }

 private:
  size_t cell(bool along_x, bool is_flipped, ptrdiff_t line, ptrdiff_t i) const {
    const ptrdiff_t x = along_x ? i : line;
    const ptrdiff_t y = along_x ? line : i;
    return size_t((is_flipped ? height_ - 1 - y : y) * width_ + x);
  }

  bool isStep(size_t a, size_t b) const {
    const float here = inv_z_[a], next = inv_z_[b];
    return here >= 0 && next >= 0 && std::abs(here - next) > kStep * std::max(here, next);
  }

  // How much colour changes from a cell to the next.
  int change(bool along_x, ptrdiff_t line, ptrdiff_t i) const {
    const Rgb& here = colors_[cell(along_x, false, line, i)];
    const Rgb& next = colors_[cell(along_x, false, line, i + 1)];
    int sum = 0;
    for (size_t channel = 0; channel < here.size(); ++channel) {
      sum += std::abs(int{here[channel]} - int{next[channel]});
    }
    return sum;
  }

  bool isEdge(bool along_x, ptrdiff_t line, ptrdiff_t i) const {
    int at_step = 0, beside = 0;
    for (ptrdiff_t distance = -kBeside; distance <= kBeside; ++distance) {
      int& largest = std::abs(distance) <= kSlack ? at_step : beside;
      // The cell right beside belongs to neither: edges are blurred.
      if (std::abs(distance) == kSlack + 1) continue;
      largest = std::max(largest, change(along_x, line, i + distance));
    }
    return at_step > beside && at_step > kEdgeMin;
  }

  ptrdiff_t width_ = 0, height_ = 0;
  std::vector<float> inv_z_;
  std::vector<Rgb> colors_;
};

double shareOf(const CoarseGrid::Count& rows, const CoarseGrid::Count& columns) {
  const uint64_t steps = rows.steps + columns.steps;
  return steps == 0 ? 0 : double(rows.agreeing + columns.agreeing) / double(steps);
}

}  // namespace

EdgeAgreement edgeAgreement(const DepthSamples& samples, const ColorPixels& color) {
  const CoarseGrid grid(samples, color);
  const CoarseGrid::Count rows = grid.count(true, false), columns = grid.count(false, false);
  return {.step_count = rows.steps + columns.steps,
          .as_is = shareOf(rows, columns),
          .flipped = shareOf(grid.count(true, true), grid.count(false, true))};
}

std::vector<Suspicion> suspectOrientation(const EdgeAgreement& agreement) {
  const bool is_flipped = agreement.step_count >= kStepsMin && agreement.flipped >= kAgrees &&
                          agreement.as_is <= kDisagrees &&
                          agreement.flipped >= kClearly * agreement.as_is;
  if (!is_flipped) return {};
  const auto percent = [](double share) { return std::round(100 * share); };
  return {{.kind = "upside-down",
           .sentence = strCat("depth seems to be upside down: ", percent(agreement.flipped),
                              " % of its edges match edges of colour if it is flipped, but ",
                              percent(agreement.as_is), " % as it is"),
           .remedy = {}}};
}

}  // namespace viewloom::inspect
