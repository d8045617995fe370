// SPDX-License-Identifier: Apache-2.0
// Suggests known names for a word that is not one of them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace viewloom {

// The names that somebody who wrote `word` probably meant, nearest first, at most three; empty when
// none is near. Case does not count. A slip is an inserted, missing or replaced letter, or two
// letters swapped. A name is also near when `word` is its beginning, or its last part after a '.'.
std::vector<std::string> nearestNames(std::string_view word, std::span<const std::string> names);

// The first of them; "" when none is near.
std::string nearestName(std::string_view word, std::span<const std::string> names);

// `did you mean "portrait" or "portrait-native"?`; "" when none is near. Quotes names as they are:
// names from outside must be free of control characters.
std::string didYouMean(std::string_view word, std::span<const std::string> names);

// `there is no "potrait"; there are go, portrait; did you mean "portrait"?`
std::string noSuchName(std::string_view word, std::span<const std::string> names);

}  // namespace viewloom
