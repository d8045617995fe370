// SPDX-License-Identifier: Apache-2.0
#include "fidelity/flicker.h"

#include <cmath>

#include "base/check.h"

namespace viewloom::fidelity {

double flicker(std::span<const ScoredImage> got, std::span<const ScoredImage> truth,
               const InnerPart& inner) {
  VIEWLOOM_CHECK(got.size() == truth.size() && got.size() >= 2);
  double sum = 0;
  uint64_t count = 0;
  for (size_t view = 0; view + 1 < got.size(); ++view) {
    const auto errorOf = [&](size_t which, size_t sample) {
      return double{got[which].rgb[sample]} - double{truth[which].rgb[sample]};
    };
    inner.forEach([&](size_t pixel) {
      for (size_t sample = 3 * pixel; sample < 3 * pixel + 3; ++sample) {
        sum += std::abs(errorOf(view, sample) - errorOf(view + 1, sample));
        ++count;
      }
    });
  }
  return 255 * sum / static_cast<double>(count);
}

}  // namespace viewloom::fidelity
