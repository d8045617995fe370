// SPDX-License-Identifier: Apache-2.0
#include "lib/access_token.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr size_t kTokenBytesMax = 8192;
constexpr std::string_view kBlanks = " \t\r\n";

std::string withoutBlanks(std::string_view text) {
  const size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
  const size_t end = text.find_last_not_of(kBlanks) + 1;
  return std::string(text.substr(begin, std::max(begin, end) - begin));
}

}  // namespace

std::string tokenOfEnvironment() {
  const char* const text = std::getenv("VIEWLOOM_TOKEN");
  return text == nullptr ? "" : withoutBlanks(text);
}

absl::StatusOr<std::string> readAccessToken(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(kTokenBytesMax + kBlanks.size() + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!file.is_open() || file.bad()) {
    return absl::InvalidArgumentError(
        strCat(printable(path), ": cannot be read; name a file that holds an access token"));
  }
  text.resize(static_cast<size_t>(file.gcount()));
  std::string token = withoutBlanks(text);
  if (isSendableToken(token)) return token;
  return absl::InvalidArgumentError(
      strCat(printable(path),
             ": is no file with an access token; accepted is one line, as `viewloomd token add` "
             "prints it"));
}

bool isSendableToken(std::string_view text) {
  return !text.empty() && text.size() <= kTokenBytesMax &&
         std::ranges::all_of(text, [](char c) { return c > ' ' && c <= '~'; });
}

}  // namespace viewloom
