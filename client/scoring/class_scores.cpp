// SPDX-License-Identifier: Apache-2.0
#include "scoring/class_scores.h"

#include <algorithm>
#include <vector>

namespace viewloom {

ClassScores scoreByClass(const ImageComparison& comparison, std::span<const PixelClass> classes) {
  std::vector<uint8_t> selected(classes.size());
  const auto score = [&](auto is_selected) {
    std::transform(classes.begin(), classes.end(), selected.begin(), is_selected);
    return comparison.score(selected, classes.size());
  };
  const auto of_class = [&](PixelClass wanted) {
    return score([wanted](PixelClass given) { return given == wanted; });
  };
  return {.covered = of_class(PixelClass::kCovered),
          .hidden = of_class(PixelClass::kHidden),
          .outside = of_class(PixelClass::kOutside),
          .all = score([](PixelClass) { return true; })};
}

}  // namespace viewloom
