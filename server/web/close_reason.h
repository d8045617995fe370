// SPDX-License-Identifier: Apache-2.0
// Code and text of a close frame, which say why a WebSocket ends.
#pragma once

#include <string>

#include "base/printable.h"
#include "base/status.h"
#include "web/asio.h"

namespace viewloom {

// OK = the server leaves.
inline websocket::close_reason closeReason(const absl::Status& status) {
  // A close frame holds 125 bytes, two of them the code.
  constexpr size_t kTextBytesMax = 123;
  websocket::close_reason reason(websocket::close_code::going_away);
  if (status.ok()) return reason;
  reason.code = absl::IsInternal(status) ? websocket::close_code::internal_error
                                         : websocket::close_code::policy_error;
  const std::string message(status.message());
  reason.reason = std::string(wholeCharacters(message, kTextBytesMax));
  return reason;
}

}  // namespace viewloom
