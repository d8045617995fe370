// SPDX-License-Identifier: Apache-2.0
// An option that takes one of a few words.
#pragma once

#include <CLI/CLI.hpp>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace viewloom::usage {

// Accepts these words only, and suggests the nearest of them to another.
CLI::Validator oneOf(std::vector<std::string> words);

// The words are the keys.
template <typename Value>
CLI::Validator oneOf(const std::map<std::string, Value>& values) {
  std::vector<std::string> words;
  for (const auto& [word, value] : values) words.push_back(word);
  return oneOf(std::move(words));
}

}  // namespace viewloom::usage
