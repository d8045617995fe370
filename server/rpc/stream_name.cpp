// SPDX-License-Identifier: Apache-2.0
#include "rpc/stream_name.h"

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "base/nearest_name.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr size_t kNameLengthMax = 64;

bool isNameCharacter(char c) {
  return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' || c == '-';
}

}  // namespace

absl::Status validateStreamName(const std::string& name, std::string_view field) {
  const bool fits = !name.empty() && name.size() <= kNameLengthMax;
  if (fits && std::all_of(name.begin(), name.end(), isNameCharacter)) return absl::OkStatus();
  return invalidField(
      field, strCat("the name of the stream is \"", absl::CEscape(name.substr(0, kNameLengthMax)),
                    "\"; accepted is a name of 1 to ", kNameLengthMax,
                    " characters from A-Z a-z 0-9 . _ -"));
}

absl::Status noSuchStream(const std::string& name, std::string_view field,
                          const StreamDirectory& directory, const Caller& caller) {
  const std::vector<StreamEntry> entries = directory.list();
  std::vector<std::string> names;
  for (const StreamEntry& entry : entries) {
    if (caller.sees(entry.name)) names.push_back(entry.name);
  }
  return fieldError(
      absl::StatusCode::kNotFound, field,
      strCat(noSuchName("stream", name, names), names.empty() ? "; start a publisher first" : ""));
}

}  // namespace viewloom
