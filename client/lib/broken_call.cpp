// SPDX-License-Identifier: Apache-2.0
#include "lib/broken_call.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "base/str_cat.h"
#include "lib/channel.h"

namespace viewloom {
namespace {

struct Cause {
  absl::StatusCode code;
  std::string_view sign;  // part of gRPC's message; "" = any
  std::string_view cause;
  std::string_view remedy;
};

constexpr std::string_view kLimitsOfProxy =
    "behind nginx, set client_max_body_size 0, grpc_read_timeout 1d, grpc_send_timeout 1d and "
    "client_body_timeout 1d; in other proxies, lift the limits on the bytes and the duration of a "
    "call";

constexpr std::array kCauses = {
    Cause{absl::StatusCode::kUnknown, "status: 413", "a proxy takes no more bytes in one call",
          "raise its body limit (nginx: client_max_body_size 0)"},
    Cause{absl::StatusCode::kUnavailable, "status: 504", "a proxy lost patience with the server",
          kLimitsOfProxy},
    Cause{absl::StatusCode::kUnavailable, "status: 502", "a proxy cannot reach the server",
          "start the server, or correct the address that the proxy passes calls to"},
    Cause{absl::StatusCode::kUnavailable, "status: 503", "a proxy has no server to pass calls to",
          "start the server, or correct the address that the proxy passes calls to"},
    Cause{absl::StatusCode::kUnavailable, "status: 429", "a proxy limits the rate of calls",
          "raise that limit"},
    Cause{absl::StatusCode::kUnavailable, "wrong version number", "the server speaks no TLS",
          "write its address without https://"},
    Cause{absl::StatusCode::kUnavailable, ": Socket closed",
          "the server closed the connection before the call",
          "if it speaks TLS, write its address as https://HOST:PORT; if it asks for certificates, "
          "give --tls-cert and --tls-key"},
    Cause{absl::StatusCode::kUnimplemented, "status: 404", "no viewloomd answers at this address",
          "give the address of gRPC, which is not that of the page (50051 is usual)"},
    Cause{absl::StatusCode::kInternal, "RST_STREAM", "a proxy or the network broke the call off",
          kLimitsOfProxy},
    Cause{absl::StatusCode::kCancelled, "RST_STREAM", "a proxy or the network broke the call off",
          kLimitsOfProxy},
    Cause{absl::StatusCode::kInternal, "", "a proxy or the network broke the call off",
          kLimitsOfProxy},
    Cause{absl::StatusCode::kDeadlineExceeded, "", "a proxy limits how long a call may last",
          kLimitsOfProxy},
    Cause{absl::StatusCode::kResourceExhausted, "larger than max",
          "a message is larger than the other side takes", "use client and server of one version"},
    Cause{absl::StatusCode::kResourceExhausted, "",
          "a proxy or the server's network library has reached a limit",
          "publish fewer or smaller frames, or raise the limit"},
};

// Stands in gRPC's message before a refusal of lib/credentials.
constexpr std::string_view kRefusedCertificate =
    "Custom verification check failed with error: UNAUTHENTICATED: ";

// Signs in gRPC's words, and what they mean.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kConnections{{
    {"DNS resolution failed", "there is no host of that name"},
    {"Domain name not found", "there is no host of that name"},
    {"http1.x", "what answers there is no gRPC server, perhaps a page"},
    {"watchdog timeout", "it has stopped answering"},
    {"GOAWAY", "it has ended the connection"},
    {"Socket closed", "it has closed the connection"},
}};

}  // namespace

std::string connectionProblem(const absl::Status& status) {
  for (const auto& [sign, meaning] : kConnections) {
    if (absl::StrContains(status.message(), {sign.data(), sign.size()})) {
      return std::string(meaning);
    }
  }
  const std::string message(status.message());
  // "failed to connect to all addresses; last error: UNKNOWN: ipv4:...: Connection refused".
  const size_t last = message.rfind(": ");
  if (message.find("ailed to connect") == std::string::npos || last == std::string::npos) {
    return message;
  }
  std::string cause = message.substr(last + 2);
  if (!cause.empty()) cause[0] = absl::ascii_tolower(static_cast<unsigned char>(cause[0]));
  return cause;
}

std::string explainBrokenCall(const absl::Status& status) {
  if (!isFromTransport(status)) return "";
  const std::string message(status.message());
  if (const size_t refusal = message.find(kRefusedCertificate); refusal != std::string::npos) {
    return message.substr(refusal + kRefusedCertificate.size());
  }
  const auto* cause = std::find_if(kCauses.begin(), kCauses.end(), [&](const Cause& candidate) {
    const absl::string_view sign(candidate.sign.data(), candidate.sign.size());
    return candidate.code == status.code() && absl::StrContains(status.message(), sign);
  });
  if (cause == kCauses.end()) return "";
  return strCat(std::string(cause->cause), " (", status.message(), "); ",
                std::string(cause->remedy));
}

}  // namespace viewloom
