// SPDX-License-Identifier: Apache-2.0
// Which events of a while the audit log writes: equal ones once, and of one client only so many.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "access/audit_event.h"

namespace viewloom {

// Without it, somebody who asks for the same picture again and again would fill the disk, and hide
// the lines of others. Thread-safety: none.
class AuditWindow {
 public:
  static constexpr int64_t kSeconds = 600;
  // Lines of one client, and of all: the first ones, each of which a line with a count may follow.
  static constexpr size_t kClientLinesMax = 1000;
  static constexpr size_t kLinesMax = 10'000;

  // Whether the window is over. It begins with its first event.
  bool isOver(int64_t now_s) const;
  // True for an event that gets a line of its own; others are counted.
  bool isNew(const AuditEvent& event, int64_t now_s);

  struct Counted {
    AuditEvent event;
    int64_t last_s = 0;
  };
  // The events that were counted, with their counts, in a fixed order. The window is empty then.
  std::vector<Counted> close();

 private:
  // Outcome, operation, peer, proof and id, stream, reason.
  using Key =
      std::tuple<AuditOutcome, std::string, std::string, std::string, std::string, std::string>;

  // Those of a client beyond its lines: `event` is about the client alone.
  AuditEvent remainderOf(const AuditEvent& event, const std::string& client) const;

  int64_t begin_s_ = 0;
  std::map<Key, Counted> written_;            // count: further ones like it
  std::map<std::string, size_t> line_count_;  // by client
  std::map<Key, Counted> left_out_;           // by client and outcome
};

}  // namespace viewloom
