// SPDX-License-Identifier: Apache-2.0
// Which of two atlases on their way goes first: eyes that move wait for nobody, and atlases of many
// rays let others by, but all of them leave others their share.
#pragma once

#include <algorithm>
#include <cstdint>

namespace viewloom {

// Rays that an atlas is walked by before others go first: a large quilt's.
inline constexpr int64_t kTurnRays = int64_t{1} << 24;
// Time of worker threads that an atlas takes before others go first: that of most atlases.
inline constexpr int64_t kTurn_ns = 50'000'000;

// An atlas on its way, before a device or before worker threads: when it is due, and how much it
// has had. Thread-safety: none.
struct Claim {
  int64_t deadline_ns = 0;
  bool is_tracked = false;
  int64_t turn = 0;  // so much is what most atlases need: rays, or ns
  int64_t had = 0;   // in the same unit

  // Others go first, or take turns with it.
  bool isLong() const { return !is_tracked && had >= turn; }
};

// Order of two begun pictures, part by part: the sooner first, tracked displays before all others,
// however long those are overdue. A long one comes last, until another has had as much.
inline bool goesFirst(const Claim& a, const Claim& b) {
  if (a.isLong() != b.isLong()) return b.isLong();
  if (a.is_tracked != b.is_tracked) return a.is_tracked;
  return a.deadline_ns < b.deadline_ns;
}

// The turn of those who go first. While others wait, they get a part of the work for every
// kFirstPerOther parts: so no display stands still. Work in any unit, as it was done.
// Thread-safety: none.
template <int64_t kFirstPerOther>
class Turn {
 public:
  // Whether the next part is of another atlas.
  bool isOver() const { return owed_ > 0; }
  // A part of an atlas. What is owed never exceeds it: who comes late has no claim to the past.
  void note(bool goes_first, int64_t work) {
    owed_ =
        goes_first ? std::min(owed_ + work / kFirstPerOther, work) : std::max(owed_ - work, -work);
  }

 private:
  int64_t owed_ = 0;  // to others
};

// A quarter of the work is left to others, however fast poses come: so answers to eyes take no more
// than a third longer.
using EyesTurn = Turn<3>;
// Long atlases and all others share the work alike.
using ShortTurn = Turn<1>;

// Shares a device, or worker threads, out among the atlases on their way. Thread-safety: none.
class Turns {
 public:
  // The items in line; nullptr = there is none.
  template <typename Item>
  struct Line {
    const Item* first = nullptr;
    const Item* in_turn = nullptr;  // would have to wait for the first, but it is its turn
  };

  // `claim_of` answers with a pointer to the claim of an item, or nullptr where there is nothing to
  // do for it. Items with equal claims keep their order.
  template <typename Items, typename ClaimOf>
  auto lineUp(const Items& items, const ClaimOf& claim_of) const {
    Line<typename Items::value_type> line;
    line.first = firstOf(items, claim_of, [](const Claim&) { return true; });
    if (line.first == nullptr) return line;
    const Claim& first = *claim_of(*line.first);
    if (!isOver(first)) return line;
    line.in_turn = firstOf(items, claim_of, [&](const Claim& claim) {
      return first.is_tracked ? !claim.is_tracked : claim.isLong();
    });
    return line;
  }

  // The atlas of the claim has had a part.
  void note(Claim& claim, int64_t work) {
    eyes_turn_.note(claim.is_tracked, work);
    if (!claim.is_tracked) short_turn_.note(!claim.isLong(), work);
    claim.had += work;
  }

 private:
  bool isOver(const Claim& first) const {
    if (first.isLong()) return false;
    return first.is_tracked ? eyes_turn_.isOver() : short_turn_.isOver();
  }

  template <typename Items, typename ClaimOf, typename Counts>
  static auto firstOf(const Items& items, const ClaimOf& claim_of, const Counts& counts) {
    const typename Items::value_type* first = nullptr;
    for (const auto& item : items) {
      const Claim* const claim = claim_of(item);
      if (claim == nullptr || !counts(*claim)) continue;
      if (first == nullptr || goesFirst(*claim, *claim_of(*first))) first = &item;
    }
    return first;
  }

  EyesTurn eyes_turn_;
  ShortTurn short_turn_;  // of those that are not tracked
};

}  // namespace viewloom
