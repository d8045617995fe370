// SPDX-License-Identifier: Apache-2.0
#include "web/url.h"

#include <algorithm>
#include <charconv>

#include "absl/strings/ascii.h"
#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

enum class Plus { kLiteral, kSpace };

absl::StatusOr<std::string> decode(std::string_view escaped, Plus plus) {
  std::string plain;
  plain.reserve(escaped.size());
  for (size_t i = 0; i < escaped.size(); ++i) {
    char character = escaped[i];
    if (character == '+' && plus == Plus::kSpace) character = ' ';
    if (character == '%') {
      unsigned value = 0;
      const char* begin = escaped.data() + i + 1;
      const char* end = begin + 2;
      if (i + 2 >= escaped.size() || std::from_chars(begin, end, value, 16).ptr != end) {
        return invalidField("url", strCat("the escape \"", std::string(escaped.substr(i, 3)),
                                          "\" is broken; accepted is % and two "
                                          "hexadecimal digits"));
      }
      character = static_cast<char>(value);
      i += 2;
    }
    if (absl::ascii_iscntrl(static_cast<unsigned char>(character))) {
      return invalidField("url", "the address has a control character; leave it out");
    }
    plain.push_back(character);
  }
  return plain;
}

absl::Status parseParameters(std::string_view query, QueryParameters& parameters) {
  while (!query.empty()) {
    const std::string_view pair = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(pair.size() + 1, query.size()));
    if (pair.empty()) continue;
    const size_t equals = pair.find('=');
    const absl::StatusOr<std::string> key = decode(pair.substr(0, equals), Plus::kSpace);
    VIEWLOOM_RETURN_IF_ERROR(key.status());
    const absl::StatusOr<std::string> value =
        decode(equals == std::string_view::npos ? std::string_view() : pair.substr(equals + 1),
               Plus::kSpace);
    VIEWLOOM_RETURN_IF_ERROR(value.status());
    if (!parameters.emplace(*key, *value).second)
      return invalidField(quotable(*key), "the parameter is given twice; accepted is once");
  }
  return absl::OkStatus();
}

}  // namespace

std::string percentEncoded(std::string_view plain) {
  std::string escaped;
  for (const char character : plain) {
    const auto byte = static_cast<unsigned char>(character);
    const bool unreserved = absl::ascii_isalnum(byte) ||
                            std::string_view("-._~").find(character) != std::string_view::npos;
    if (unreserved) {
      escaped.push_back(character);
    } else {
      escaped += strCat("%", absl::Hex(byte, absl::kZeroPad2));
    }
  }
  return escaped;
}

absl::StatusOr<Url> parseUrl(std::string_view target) {
  target = target.substr(0, target.find('#'));
  if (target.empty() || target.front() != '/') {
    return invalidField("url", "the address is not a path; accepted is a path that begins with /");
  }
  const size_t question = target.find('?');
  const absl::StatusOr<std::string> path = decode(target.substr(0, question), Plus::kLiteral);
  VIEWLOOM_RETURN_IF_ERROR(path.status());
  Url url{.path = *path, .parameters = {}};
  if (question != std::string_view::npos) {
    VIEWLOOM_RETURN_IF_ERROR(parseParameters(target.substr(question + 1), url.parameters));
  }
  return url;
}

std::string queryString(const QueryParameters& parameters) {
  std::string query;
  for (const auto& [key, value] : parameters) {
    query += strCat(query.empty() ? "" : "&", percentEncoded(key), "=", percentEncoded(value));
  }
  return query;
}

}  // namespace viewloom
