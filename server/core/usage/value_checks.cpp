// SPDX-License-Identifier: Apache-2.0
#include "usage/value_checks.h"

#include <algorithm>
#include <utility>

#include "base/nearest_name.h"

namespace viewloom::usage {

CLI::Validator oneOf(std::vector<std::string> words) {
  const auto refuse = [words = std::move(words)](const std::string& given) {
    if (std::ranges::find(words, given) != words.end()) return std::string();
    const std::string meant = didYouMean(given, words);
    return strCat("got \"", printable(given), "\"; accepted are ", joined(words, ", "),
                  meant.empty() ? "" : "; ", meant);
  };
  return {[refuse](std::string& given) { return refuse(given); }, ""};
}

}  // namespace viewloom::usage
