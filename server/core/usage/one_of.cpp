// SPDX-License-Identifier: Apache-2.0
#include "usage/one_of.h"

#include <algorithm>
#include <utility>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom::usage {
namespace {

std::string joined(const std::vector<std::string>& words, const char* separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

}  // namespace

CLI::Validator oneOf(std::vector<std::string> words) {
  const std::string description = strCat("{", joined(words, ","), "}");
  const auto refuse = [words = std::move(words)](const std::string& given) {
    if (std::ranges::find(words, given) != words.end()) return std::string();
    const std::string meant = didYouMean(given, words);
    return strCat("got \"", printable(given), "\"; accepted are ", joined(words, ", "),
                  meant.empty() ? "" : "; ", meant);
  };
  return CLI::Validator([refuse](std::string& given) { return refuse(given); }, description);
}

}  // namespace viewloom::usage
