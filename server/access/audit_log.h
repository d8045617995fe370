// SPDX-License-Identifier: Apache-2.0
// Log of who was granted or refused what: one JSON object a line, without secrets.
//
//   {"time": "2026-11-27T08:30:00Z", "outcome": "refused", "operation": "/api/streams",
//    "peer": "10.0.0.7", "proof": "token", "id": "camera-1", "stream": "room.1", "reason": "..."}
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

#include "access/identity.h"
#include "access/utc_time.h"

namespace viewloom {

enum class AuditOutcome : uint8_t { kGranted, kRefused, kChanged };

struct AuditEvent {
  AuditOutcome outcome = AuditOutcome::kGranted;
  std::string_view operation;
  std::string peer;
  IdentityPtr identity;  // null = nobody is proven
  std::string stream;
  std::string reason;
};

// Appends to a file that only its owner may read. A file that was moved away is opened anew. At
// most 100 refusals a second are written; a further line says how many were left out.
// Thread-safety: may be called from any thread.
class AuditLog {
 public:
  // An empty path writes nothing. Throws std::runtime_error, with the remedy, if the file cannot be
  // opened.
  AuditLog(std::string path, WallClock now_s);
  ~AuditLog();
  AuditLog(const AuditLog&) = delete;
  AuditLog& operator=(const AuditLog&) = delete;

  void write(const AuditEvent& event);

 private:
  void open();
  void reopenIfMoved();
  void append(const std::string& line);
  bool isLeftOut(int64_t now_s);
  void tellLeftOut();

  const std::string path_;
  const WallClock now_s_;
  std::mutex mutex_;
  int descriptor_ = -1;
  int64_t second_s_ = 0;        // of the refusals below
  uint32_t refusal_count_ = 0;  // in this second
  uint64_t left_out_count_ = 0;
  bool has_failed_ = false;  // said in the log once
};

}  // namespace viewloom
