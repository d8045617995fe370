// SPDX-License-Identifier: Apache-2.0
#include "certificates/server_address.h"

namespace viewloom {
namespace {

constexpr std::string_view kTlsScheme = "https://";
constexpr std::string_view kPlainScheme = "http://";

}  // namespace

std::string ServerAddress::text() const {
  return has_tls ? std::string(kTlsScheme) + target : target;
}

ServerAddress parseServerAddress(std::string_view text) {
  const bool has_tls = text.starts_with(kTlsScheme);
  const bool has_scheme = has_tls || text.starts_with(kPlainScheme);
  if (has_tls) text.remove_prefix(kTlsScheme.size());
  if (has_scheme && !has_tls) text.remove_prefix(kPlainScheme.size());
  if (has_scheme && text.ends_with('/')) text.remove_suffix(1);
  return {.target = std::string(text), .has_tls = has_tls};
}

}  // namespace viewloom
