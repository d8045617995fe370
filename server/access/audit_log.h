// SPDX-License-Identifier: Apache-2.0
// Log of who was granted or refused what: one JSON object a line, without secrets.
//
//   {"time": "2026-11-27T08:30:00Z", "outcome": "refused", "operation": "/api/streams",
//    "peer": "10.0.0.7", "proof": "token", "id": "camera-1", "stream": "room.1", "reason": "..."}
#pragma once

#include <mutex>
#include <string>

#include "access/audit_event.h"
#include "access/audit_window.h"
#include "access/utc_time.h"

namespace viewloom {

// Appends to a file that only its owner may read. A file that was moved away is opened anew. Equal
// events of ten minutes become one line at once and one with their count ("count": 41), which is
// written with the first event after the ten minutes, or at the end. The same holds for events of
// one client beyond a thousand lines (audit_window.h).
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
  void tellCounted();

  const std::string path_;
  const WallClock now_s_;
  std::mutex mutex_;
  int descriptor_ = -1;
  AuditWindow window_;
  bool has_failed_ = false;  // said in the log once
};

}  // namespace viewloom
