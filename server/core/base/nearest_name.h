// SPDX-License-Identifier: Apache-2.0
// Suggests known names for a word that is not one of them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace viewloom {

// Names that somebody who wrote `word` probably meant, nearest first, at most three. Empty if none
// is near. Case does not matter. A slip is an inserted, missing or replaced letter, or two letters
// swapped. A name is also near if `word` is its beginning, or its last part after a '.'.
std::vector<std::string> nearestNames(std::string_view word, std::span<const std::string> names);

// The nearest of these names; "" if none is near.
std::string nearestName(std::string_view word, std::span<const std::string> names);

// `did you mean "portrait" or "portrait-native"?`; "" if none is near. Names are quoted unchanged,
// so names from outside must be free of control characters.
std::string didYouMean(std::string_view word, std::span<const std::string> names);

// `there is no preset "potrait"; known presets: go, portrait; did you mean "portrait"?` Lists at
// most 32 names. `noun` is the singular; without names: `there is no stream "x"; there are no
// streams yet`.
std::string noSuchName(std::string_view noun, std::string_view word,
                       std::span<const std::string> names);

}  // namespace viewloom
