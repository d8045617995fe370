// SPDX-License-Identifier: Apache-2.0
// Processor time that is left for further encodings of a display.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

#include "base/spell.h"

namespace viewloom {

// A second encoding of a picture is a favour to slow lines. It may not slow down anybody else, so
// it is granted only from time that nobody takes, and it goes when others need that time. Times are
// monotonic. Thread-safety: all methods may be called from any thread.
class CodingRoom {
 public:
  // `core_count`: cores that this server may keep busy (Processors::busyMax). Without cores there
  // is no room. `used_ns`: processor time that it has taken so far.
  CodingRoom(double core_count, std::function<int64_t()> used_ns)
      : core_count_(core_count), used_ns_(std::move(used_ns)) {}

  // To be called a few times a second.
  void look(int64_t now_ns);
  // Takes room for an encoding that keeps so many cores busy, such as 0.3. False where there is
  // none, where nothing was measured yet, or where the last one does not show in what is measured.
  bool take(double busy_core_count, int64_t now_ns);
  // Gives back the room that was taken last, which is not needed after all.
  void giveBack();
  // For a while, the server has needed all of its time: encodings that were granted have to go.
  bool isOver() const;

 private:
  struct Look {
    int64_t at_ns = 0;
    int64_t used_ns = 0;
  };

  // With the lock. Share of the cores that is taken, 0..1; none = not known yet.
  std::optional<double> load() const;

  const double core_count_;
  const std::function<int64_t()> used_ns_;
  mutable std::mutex mutex_;  // guards what follows
  std::deque<Look> looks_;    // of the last two seconds
  Spell full_;
  bool is_over_ = false;
  std::optional<int64_t> taken_ns_;  // when room was last taken
};

// No room at all, for programs that serve nobody, and tests.
CodingRoom& noCodingRoom();

}  // namespace viewloom
