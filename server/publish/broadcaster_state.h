// SPDX-License-Identifier: Apache-2.0
// Inside of the Broadcaster; only its own sources include this.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "admission/coding_room.h"
#include "admission/memory_budget.h"
#include "publish/broadcaster.h"
#include "publish/watched_displays.h"

namespace viewloom {

struct Broadcaster::State {
  State(BroadcasterLimits limits, MemoryBudget& budget, CodingRoom& room)
      : memory(budget), coding_room(room), displays(limits) {}

  MemoryBudget& memory;
  CodingRoom& coding_room;
  std::function<void(const std::string&)> on_demand_change;
  std::function<void(const std::string&)> on_eyes_served;

  mutable std::mutex mutex;  // guards what follows; never held while a subscriber is called
  bool is_draining = false;
  WatchedDisplays displays;

  // `left`: the place that the viewer gives up, here as in what follows.
  absl::Status checkRoom(bool opens_display, const WatcherPlace& left) const;
  uint64_t takeId();

  // A viewer at its place, and what there is to tell it.
  struct Joined {
    MemberPtr member;
    ActiveDisplayPtr display;
    AtlasPtr newest;
    GrowingAtlasPtr growing;
    std::string left;  // stream of the display that has gone with the place left; else empty

    // The newest atlas refers to others, which the viewer has not got.
    bool isOutOfChain() const { return newest && newest->reference_sequence != 0; }
  };
  // Joins the display with this key, or opens it. Errors as of subscribe().
  absl::StatusOr<Joined> take(const ActiveDisplay& display, const std::string& key,
                              const std::shared_ptr<Subscriber>& subscriber,
                              const WatcherPlace& left);
  absl::StatusOr<Seat> admit(const ActiveDisplay& display, const std::string& key,
                             const Subscriber& subscriber, const WatcherPlace& left) const;
  absl::StatusOr<std::optional<Joined>> join(const ActiveDisplay& display, const std::string& key,
                                             const std::shared_ptr<Subscriber>& subscriber,
                                             Seat& seat, const WatcherPlace& left);
  // Offers what is there; has an atlas made where there is none.
  void tell(const Joined& joined) const;
  // Coding of the other rung of a display; nullptr = nobody is on that.
  std::shared_ptr<DisplayCoding> otherCoding(uint64_t display_id);
  // OK where the processors have time to code the display on another rung, or do so already. True:
  // that time was taken from the room.
  absl::StatusOr<bool> payForRung(const ActiveDisplay& before, const std::string& key,
                                  int64_t now_ns);
  void announce(const std::string& stream) const {
    if (on_demand_change) on_demand_change(stream);
  }
};

}  // namespace viewloom
