// SPDX-License-Identifier: Apache-2.0
#include "base/nearest_name.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "absl/strings/ascii.h"
#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr size_t kNamesMax = 3;
constexpr size_t kListedMax = 32;    // names of a list
constexpr size_t kBeginningMin = 3;  // letters that say enough about the rest of a name

// Damerau's and Levenshtein's distance (optimal string alignment), by three rows of its table.
size_t editDistance(std::string_view from, std::string_view to) {
  std::vector<size_t> before(to.size() + 1);
  std::vector<size_t> last(to.size() + 1);
  std::vector<size_t> row(to.size() + 1);
  std::iota(last.begin(), last.end(), size_t{0});
  for (size_t i = 1; i <= from.size(); ++i) {
    row[0] = i;
    for (size_t j = 1; j <= to.size(); ++j) {
      const size_t replaced = last[j - 1] + (from[i - 1] != to[j - 1]);
      row[j] = std::min({replaced, last[j] + 1, row[j - 1] + 1});
      const bool is_swap = i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1];
      if (is_swap) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last.back();
}

// Slips from which on a name is another word: a third of the letters.
size_t limitOf(std::string_view word) {
  return std::max<size_t>(word.size() / 3, 1) + 1;
}

size_t distanceWithin(size_t limit, std::string_view word, std::string_view name) {
  const size_t difference = std::max(word.size(), name.size()) - std::min(word.size(), name.size());
  return difference < limit ? editDistance(word, name) : limit;
}

}  // namespace

std::vector<std::string> nearestNames(std::string_view word, std::span<const std::string> names) {
  const std::string wanted = absl::AsciiStrToLower({word.data(), word.size()});
  const size_t limit = limitOf(wanted);
  std::vector<std::pair<size_t, std::string>> near;
  for (const std::string& name : names) {
    const std::string lower = absl::AsciiStrToLower(name);
    const std::string_view last_part = std::string_view(lower).substr(lower.rfind('.') + 1);
    size_t distance =
        std::min(distanceWithin(limit, wanted, lower), distanceWithin(limit, wanted, last_part));
    // After every slip: a beginning says less than a whole word.
    const bool is_beginning = wanted.size() >= kBeginningMin && lower.starts_with(wanted);
    if (distance >= limit && is_beginning) distance = limit - 1;
    if (distance < limit) near.emplace_back(distance, name);
  }
  std::ranges::stable_sort(near, {}, &std::pair<size_t, std::string>::first);
  std::vector<std::string> nearest;
  for (auto& [distance, name] : near) {
    // Names much farther than the nearest one only distract from it.
    if (nearest.size() == kNamesMax || distance > near.front().first + 1) break;
    if (std::ranges::find(nearest, name) == nearest.end()) nearest.push_back(name);
  }
  return nearest;
}

std::string nearestName(std::string_view word, std::span<const std::string> names) {
  const std::vector<std::string> nearest = nearestNames(word, names);
  return nearest.empty() ? "" : nearest.front();
}

std::string didYouMean(std::string_view word, std::span<const std::string> names) {
  const std::vector<std::string> nearest = nearestNames(word, names);
  std::string text;
  for (size_t i = 0; i < nearest.size(); ++i) {
    const bool is_last = i + 1 == nearest.size();
    text += strCat(i == 0 ? "" : is_last ? " or " : ", ", "\"", nearest[i], "\"");
  }
  return text.empty() ? "" : strCat("did you mean ", text, "?");
}

std::string noSuchName(std::string_view noun, std::string_view word,
                       std::span<const std::string> names) {
  const std::string nouns = std::string(noun) + "s";
  std::string list;
  for (const std::string& name : names.first(std::min(names.size(), kListedMax))) {
    list += (list.empty() ? "" : ", ") + name;
  }
  if (names.size() > kListedMax) list += strCat(" and ", names.size() - kListedMax, " more");
  const std::string meant = didYouMean(word, names);
  return strCat(
      "there is no ", std::string(noun), " \"", quotable(word), "\"; ",
      names.empty() ? strCat("there are no ", nouns, " yet") : strCat("known ", nouns, ": ", list),
      meant.empty() ? "" : "; ", meant);
}

}  // namespace viewloom
