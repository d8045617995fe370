// SPDX-License-Identifier: Apache-2.0
// Whoever is served over one connection for longer than one reply.
#pragma once

namespace viewloom {

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
