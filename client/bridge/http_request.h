// SPDX-License-Identifier: Apache-2.0
// One request over HTTP and its answer.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "base/status.h"
#include "lib/tls_parts.h"

namespace viewloom::bridge {

struct HttpAddress {
  std::string host;  // a name or an address; IPv6 without brackets
  uint16_t port = 0;
  // How the server is known, and this client to it; null = without encryption.
  std::shared_ptr<const TlsParts> tls = nullptr;

  bool isLoopback() const;
  // "http://localhost:33334"
  std::string url() const;
};

// Reads http://HOST[:PORT][/]; with `tls`, https://HOST[:PORT][/]. INVALID_ARGUMENT, saying
// `option`, for anything else.
absl::StatusOr<HttpAddress> parseHttpAddress(std::string_view text, uint16_t default_port,
                                             std::string_view option,
                                             std::shared_ptr<const TlsParts> tls = nullptr);

struct HttpRequest {
  std::string method;  // GET or PUT
  std::string target;  // begins with '/'
  std::string json;    // the body; empty = none
  std::string token;   // access token; empty = none
};

struct HttpResponse {
  unsigned status = 0;
  std::string location;  // header; empty when not given
  std::string body;

  bool isOk() const { return status == 200; }
};

// How long an answer is waited for.
struct Patience {
  std::chrono::milliseconds timeout{15'000};
  // Whether the caller has given up; asked every 20 ms on the thread that waits. Empty = never.
  std::function<bool()> has_given_up = {};
};

// Blocks until the answer is there. UNAVAILABLE when nobody can be reached, DEADLINE_EXCEEDED,
// CANCELLED when the caller has given up, DATA_LOSS for an answer that is no HTTP or longer than
// 4 MiB, UNAUTHENTICATED where the server is not the one that is known. Nothing is sent to such a
// server. Thread-safety: may be called from any thread.
absl::StatusOr<HttpResponse> exchange(const HttpAddress& address, const HttpRequest& request,
                                      const Patience& patience);

}  // namespace viewloom::bridge
