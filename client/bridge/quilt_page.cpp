// SPDX-License-Identifier: Apache-2.0
#include "bridge/quilt_page.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/str_cat.h"
#include "bridge/json_answer.h"

namespace viewloom::bridge {
namespace {

using nlohmann::json;

constexpr unsigned kHttpFound = 302;

absl::Status checkName(const std::string& what, const std::string& name) {
  const bool is_plain = std::all_of(name.begin(), name.end(), [](char character) {
    return std::isalnum(static_cast<unsigned char>(character)) != 0 || character == '.' ||
           character == '_' || character == '-';
  });
  if (is_plain) return absl::OkStatus();
  return absl::InvalidArgumentError(strCat(
      what, ": got \"", name, "\"; accepted are letters, digits, dots, hyphens and underscores"));
}

// With everything escaped that is not unreserved (RFC 3986).
std::string percentEncoded(std::string_view plain) {
  std::string escaped;
  for (const char character : plain) {
    const auto byte = static_cast<unsigned char>(character);
    const bool is_unreserved = std::isalnum(byte) != 0 || character == '-' || character == '.' ||
                               character == '_' || character == '~';
    if (is_unreserved) {
      escaped.push_back(character);
    } else {
      escaped += strCat("%", absl::Hex(byte, absl::kZeroPad2));
    }
  }
  return escaped;
}

std::string targetOf(const QuiltQuery& query) {
  return strCat("/still/", query.stream, ".json?display=", percentEncoded(query.display),
                "&encoding=", percentEncoded(query.encoding));
}

// The same address with another ending; an aspect may have a dot, a query too.
std::string withExtension(const std::string& target, std::string_view extension) {
  const size_t query = std::min(target.find('?'), target.size());
  const size_t dot = target.rfind('.', query);
  if (dot == std::string::npos) return target;
  return strCat(target.substr(0, dot), std::string(extension), target.substr(query));
}

absl::StatusOr<HttpResponse> get(const HttpAddress& page, const std::string& target,
                                 const std::string& token, const Patience& patience) {
  absl::StatusOr<HttpResponse> response =
      exchange(page, {.method = "GET", .target = target, .json = "", .token = token}, patience);
  if (response.ok()) return response;
  const std::string reason(response.status().message());
  if (absl::IsDeadlineExceeded(response.status())) {
    return absl::DeadlineExceededError(strCat("the page at ", page.url(), " gave no answer within ",
                                              patience.timeout.count(),
                                              " ms; wait longer with --timeout SECONDS"));
  }
  const absl::Status& status = response.status();
  if (absl::IsUnauthenticated(status) || absl::IsCancelled(status)) return status;
  return absl::UnavailableError(strCat("no page of viewloomd at ", page.url(), " (", reason,
                                       "); start `viewloomd serve`, or name its page with "
                                       "--address http://HOST:PORT, or https://HOST:PORT for TLS"));
}

// Where a redirect leads: the server names an address relative to the one that was asked for, which
// also holds below a proxy's path (RFC 3986, section 5.2).
std::string followed(std::string_view target, std::string_view location) {
  const std::filesystem::path asked(target.substr(0, target.find('?')));
  const size_t path_size = std::min(location.find('?'), location.size());
  const std::filesystem::path path =
      asked.parent_path() / std::filesystem::path(location.substr(0, path_size));
  return strCat(path.lexically_normal().generic_string(), std::string(location.substr(path_size)));
}

absl::Status refused(const HttpAddress& page, const HttpResponse& response) {
  const json answer = parseAnswer(response.body);
  const json path = answer.is_object() ? answer.value("error", json()) : json();
  const json message = path.is_object() ? path.value("message", json()) : json();
  if (message.is_string()) return absl::FailedPreconditionError(message.get<std::string>());
  return absl::FailedPreconditionError(
      strCat(page.url(), " answered with HTTP status ", response.status,
             "; check that --address names the page of a viewloomd"));
}

// The address with a link, which shows the picture to those who have no token.
absl::StatusOr<std::string> signedLink(const HttpAddress& page, const std::string& target,
                                       const std::string& token, const Patience& patience) {
  const absl::StatusOr<HttpResponse> response =
      get(page, strCat("/api/link?seconds=3600&target=", percentEncoded(target)), token, patience);
  VIEWLOOM_RETURN_IF_ERROR(response.status());
  const json link = json::parse(response->body, nullptr, false);
  const json url = link.is_object() ? link.value("url", json()) : json();
  if (!response->isOk() || !url.is_string()) return refused(page, *response);
  return url.get<std::string>();
}

}  // namespace

absl::StatusOr<AddressedQuilt> findQuilt(const HttpAddress& page, const QuiltQuery& query,
                                         const Patience& patience) {
  VIEWLOOM_RETURN_IF_ERROR(checkName("stream", query.stream));
  std::string target = targetOf(query);
  absl::StatusOr<HttpResponse> response = get(page, target, query.token, patience);
  VIEWLOOM_RETURN_IF_ERROR(response.status());
  if (response->status == kHttpFound) {  // to the suffix as the server writes it
    target = withExtension(followed(target, response->location), ".json");
    response = get(page, target, query.token, patience);
    VIEWLOOM_RETURN_IF_ERROR(response.status());
  }
  const json layout = parseAnswer(response->body);
  if (!response->isOk() || !layout.is_object()) return refused(page, *response);
  AddressedQuilt quilt;
  try {
    quilt = {.uri = "",
             .columns = layout.at("columns").get<uint32_t>(),
             .rows = layout.at("rows").get<uint32_t>(),
             .view_count = layout.at("view_count").get<uint32_t>(),
             .aspect = layout.at("aspect").get<double>()};
  } catch (const json::exception&) {
    return refused(page, *response);
  }
  std::string shown = withExtension(target, query.is_motion ? ".mjpg" : ".jpg");
  if (query.is_motion) shown.replace(0, std::string_view("/still/").size(), "/stream/");
  if (!query.token.empty()) {
    const absl::StatusOr<std::string> link = signedLink(page, shown, query.token, patience);
    VIEWLOOM_RETURN_IF_ERROR(link.status());
    shown = *link;
  }
  quilt.uri = page.url() + shown;
  return quilt;
}

}  // namespace viewloom::bridge
