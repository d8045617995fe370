// SPDX-License-Identifier: Apache-2.0
#include "certificates/server_address.h"

namespace viewloom {
namespace {

constexpr std::string_view kTlsScheme = "https://";

}  // namespace

std::string ServerAddress::text() const {
  return has_tls ? std::string(kTlsScheme) + target : target;
}

ServerAddress parseServerAddress(std::string_view text) {
  const bool has_tls = text.starts_with(kTlsScheme);
  if (has_tls) text.remove_prefix(kTlsScheme.size());
  if (has_tls && text.ends_with('/')) text.remove_suffix(1);
  return {.target = std::string(text), .has_tls = has_tls};
}

}  // namespace viewloom
