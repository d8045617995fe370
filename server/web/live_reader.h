// SPDX-License-Identifier: Apache-2.0
// Whoever is served over one connection for longer than one reply.
#pragma once

#include <chrono>

namespace viewloom {

// Between two looks at whether the caller may still read, also while there is nothing to send.
inline constexpr std::chrono::seconds kRecheckInterval{1};

// Thread-safety: on the strand of the connection.
class LiveReader {
 public:
  virtual ~LiveReader() = default;
  // The server drains: ends in good order as soon as what is being written is written.
  virtual void leave() = 0;
  // Ends the connection at once.
  virtual void cut() = 0;
};

}  // namespace viewloom
