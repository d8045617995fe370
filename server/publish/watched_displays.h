// SPDX-License-Identifier: Apache-2.0
// The displays that are watched now, with the viewers of each.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "admission/memory_budget.h"
#include "publish/broadcaster.h"
#include "publish/member.h"

namespace viewloom {

struct WatchedDisplay {
  ActiveDisplayPtr active;
  std::string key;     // stream, picture and encoding
  Reservation memory;  // of whoever opened it
  std::vector<MemberPtr> members;
  std::shared_ptr<const AtlasLayout> layout;
  AtlasPtr newest;
  GrowingAtlasPtr growing;     // the newest that has begun, unless it is whole
  uint64_t last_sequence = 0;  // of all that have begun
  uint64_t atlas_count = 0;
};

// Memory of a viewer, and of the display if it opens one.
struct Seat {
  bool opens = false;
  Reservation display;
  Reservation viewer;
};

// Takes a seat into the budget, for the viewer `identity`. RESOURCE_EXHAUSTED where there is no
// room.
absl::StatusOr<Seat> admitSeat(MemoryBudget& memory, const DisplaySpec& spec,
                               const EncodingSpec& encoding, const std::string& identity,
                               bool opens);

// Thread-safety: none.
class WatchedDisplays {
 public:
  explicit WatchedDisplays(BroadcasterLimits limits) : limits_(limits) {}

  // Next id of a display or a viewer.
  uint64_t takeId() { return next_id_++; }

  // OK, or over which limit one more viewer is. `left`: the place that this viewer gives up.
  absl::Status checkRoom(bool opens_display, const WatcherPlace& left) const;

  bool isOpen(const std::string& key) const { return id_of_key_.contains(key); }
  // Expects a key that is not open; gives the display its id.
  WatchedDisplay& open(ActiveDisplay active, const std::string& key, Reservation memory);
  // Expects a key that is open.
  WatchedDisplay& at(const std::string& key) { return displays_.at(id_of_key_.at(key)); }
  // nullptr = nobody watches it any more.
  WatchedDisplay* find(uint64_t id);
  const WatchedDisplay* find(uint64_t id) const;
  const std::map<uint64_t, WatchedDisplay>& all() const { return displays_; }

  void add(WatchedDisplay& display, MemberPtr member);
  // True when the display went with its last member; then `stream` is its stream.
  bool remove(const WatcherPlace& place, std::string& stream);
  // Its members, who are to be told.
  std::vector<MemberPtr> close(uint64_t id);

 private:
  static void noteMembers(WatchedDisplay& display);

  const BroadcasterLimits limits_;
  uint64_t next_id_ = 1;
  uint32_t member_count_ = 0;
  std::map<uint64_t, WatchedDisplay> displays_;  // by id
  std::map<std::string, uint64_t> id_of_key_;
};

}  // namespace viewloom
