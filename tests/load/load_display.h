// SPDX-License-Identifier: Apache-2.0
// A display that watches a stream and keeps book of what comes.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "lib/watcher.h"
#include "load/percentiles.h"

namespace viewloom::load {

struct DisplayBook {
  std::string stream;
  std::string kind;
  bool is_slow = false;
  WatcherCounts counts;
  uint64_t sequences_back = 0;                // atlases whose sequence did not grow
  uint64_t frames_back = 0;                   // atlases of an older frame than the one before
  Percentiles latency;                        // capture to arrival, both on this machine
  std::map<std::string, Percentiles> stages;  // of StageTimes, by field without _ns
  absl::Status end;
};

// Kinds, sizes and encodings go round with the index.
v1::OpenDisplay mixedDisplay(uint32_t index, const std::string& stream);

// Thread-safety: none but the watcher's own; one owner.
class LoadDisplay {
 public:
  // Begins at once. A slow one pauses for a second over each atlas.
  LoadDisplay(const std::shared_ptr<grpc::Channel>& channel, const v1::OpenDisplay& open,
              bool is_slow);
  DisplayBook finish();

 private:
  void note(const Atlas& atlas);

  std::mutex mutex_;
  DisplayBook book_;
  uint64_t last_sequence_ = 0;
  uint64_t last_frame_ = 0;
  Watcher watcher_;  // last: it calls note() until it is gone
};

}  // namespace viewloom::load
