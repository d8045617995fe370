// SPDX-License-Identifier: Apache-2.0
#include "config/near_miss.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace viewloom {
namespace {

// Levenshtein's distance, one row of his table at a time.
size_t editDistance(std::string_view from, std::string_view to) {
  std::vector<size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < from.size(); ++i) {
    size_t diagonal = std::exchange(row[0], i + 1);
    for (size_t j = 0; j < to.size(); ++j) {
      const size_t replaced = diagonal + (from[i] != to[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearMiss(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  // A third of the letters wrong is another word.
  size_t best_distance = std::max<size_t>(word.size() / 3, 1) + 1;
  for (const std::string& candidate : candidates) {
    const std::string_view last_part = std::string_view(candidate).substr(candidate.rfind('.') + 1);
    const size_t distance = std::min(editDistance(word, candidate), editDistance(word, last_part));
    if (distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

}  // namespace viewloom
