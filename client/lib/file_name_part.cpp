// SPDX-License-Identifier: Apache-2.0
#include "lib/file_name_part.h"

#include <algorithm>

#include "absl/strings/ascii.h"

namespace viewloom {
namespace {

constexpr size_t kPartLengthMax = 64;
constexpr size_t kNameLengthMax = 128;

}  // namespace

bool isFileNamePart(std::string_view text) {
  return text.size() <= kPartLengthMax && std::ranges::all_of(text, [](char letter) {
           return absl::ascii_isalnum(static_cast<unsigned char>(letter)) || letter == '_' ||
                  letter == '-' || letter == '.';
         });
}

std::string fileNameFrom(std::string_view text) {
  std::string name(text.substr(0, kNameLengthMax));
  for (char& letter : name) {
    const bool is_control = absl::ascii_iscntrl(static_cast<unsigned char>(letter));
    if (letter == '/' || letter == '\\' || is_control) letter = '_';
  }
  if (name.empty()) return "stream";
  if (name.front() == '.' || name.front() == '-') name.front() = '_';
  return name;
}

}  // namespace viewloom
