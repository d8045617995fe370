// SPDX-License-Identifier: Apache-2.0
#include "web/content_disposition.h"

#include "absl/strings/ascii.h"
#include "base/str_cat.h"
#include "web/url.h"

namespace viewloom {
namespace {

constexpr std::string_view kPlainMarks = "-._ ()+,=@";

// Hidden files begin with a dot, and so do the names of folders above.
std::string plainName(std::string_view file_name) {
  const bool needs_front = file_name.empty() || file_name.front() == '.';
  std::string plain = needs_front ? "_" : "";
  for (const char character : file_name) {
    const bool is_plain = absl::ascii_isalnum(static_cast<unsigned char>(character)) ||
                          kPlainMarks.find(character) != std::string_view::npos;
    plain.push_back(is_plain ? character : '_');
  }
  return plain;
}

}  // namespace

std::string contentDisposition(std::string_view file_name) {
  const std::string plain = plainName(file_name);
  std::string value = strCat("inline; filename=\"", plain, "\"");
  if (plain != file_name) value += strCat("; filename*=UTF-8''", percentEncoded(file_name));
  return value;
}

}  // namespace viewloom
