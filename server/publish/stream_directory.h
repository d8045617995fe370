// SPDX-License-Identifier: Apache-2.0
// Which streams exist, who publishes them, and how they fare.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/status.h"
#include "frame/frame_sink.h"
#include "frame/size.h"
#include "frame/stage_times.h"

namespace viewloom {

struct StreamEntry {
  std::string name;
  bool live = false;          // a publisher is connected
  uint64_t frame_number = 0;  // newest resident structure
  SizePx size_px;
  uint32_t layer_count = 0;
  double rate_hz = 0;  // frames received whole, over the last two seconds
  uint64_t received_count = 0;
  uint64_t replaced_count = 0;
  uint64_t refused_count = 0;
  uint64_t used_count = 0;  // reported, and neither replaced nor refused
  SourceStats stats;
};

// Thread-safety: all methods may be called from any thread.
class StreamDirectory {
 public:
  // The clock must outlive the directory and its claims.
  StreamDirectory(const Clock& clock, uint32_t stream_count_max);
  ~StreamDirectory();

  // A publisher's hold on a name; letting go is destroying it. The entry stays, not live, so that
  // subscribers keep the resident structure.
  class Claim;

  // RESOURCE_EXHAUSTED over the limit. ALREADY_EXISTS, saying who has the name and since when,
  // when another session holds it; worth another try (base/status.h) where its publisher is on the
  // same host, and so the same user's. The same, non-empty session id takes the stream over:
  // `on_takeover` of the old is called, once.
  absl::StatusOr<std::unique_ptr<Claim>> claim(const std::string& stream,
                                               const std::string& session_id,
                                               std::function<void()> on_takeover,
                                               const std::string& host = "");

  bool exists(const std::string& stream) const;
  // StreamEntry::rate_hz of one stream; 0 for a stream that is not there.
  double rateHz(const std::string& stream) const;
  // Sorted by name.
  std::vector<StreamEntry> list() const;

  // Asked, when the directory is full or memory is short, about streams without a publisher, the
  // one longest without it first. Whoever answers true lets go of what it keeps for the stream; its
  // entry goes.
  void onRoomNeeded(std::function<bool(const std::string& stream)> may_forget);

  // Forgets the stream that has been without a publisher longest, if that is at least so long, and
  // if whoever is asked about it lets it go. False = there is none.
  bool forgetOldest(int64_t unused_for_ns);

  // Each frame once, by whoever hands out its report.
  void countReceived(const std::string& stream);
  void countReported(const std::string& stream, FrameOutcome outcome);
  void noteResident(const std::string& stream, uint64_t frame_number, SizePx size_px,
                    uint32_t layer_count, const SourceStats& stats);

 private:
  struct State;
  std::shared_ptr<State> state_;
};

class StreamDirectory::Claim {
 public:
  Claim(std::shared_ptr<State> state, std::string stream, uint64_t claim_id, uint64_t session);
  ~Claim();

  // Numbers publishers' sessions, from 1: the same for a session that comes back under its id, as
  // long as no other one has had the stream.
  uint64_t session() const { return session_; }

 private:
  std::shared_ptr<State> state_;
  std::string stream_;
  uint64_t claim_id_;
  uint64_t session_;
};

}  // namespace viewloom
