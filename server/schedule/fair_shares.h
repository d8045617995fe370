// SPDX-License-Identifier: Apache-2.0
// Order in which work goes: a fair queue over identities, their streams, and the displays of those,
// in time that work has taken.
//
// Start-time fair queueing: whoever pays for a piece of work has a virtual time, which is moved on
// by how long the piece takes. The one whose virtual time is least goes next. Who was idle begins
// where the others are, and gets no credit for the past but kCredit_ns. So does who is further
// behind, since a device served others; of all of those the one goes next that had least.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/payer.h"
#include "schedule/eyes_turn.h"

namespace viewloom {

// Time that whoever was idle may take before the others get their turn: a small picture's.
inline constexpr int64_t kCredit_ns = 30'000'000;
// Displays of one stream whose shares differ by no more than this go in the order of their
// deadlines, so that most atlases are finished before the next one begins.
inline constexpr int64_t kInOrder_ns = 20'000'000;

// Times by which a piece may exceed its prediction before the rest is nobody's.
inline constexpr int64_t kPaidMax = 10;

// Viewers or publishers that some work is for, each once.
using Payers = std::vector<Payer>;

// Work that waits, or is under way part by part, and those who pay for it.
struct Claim {
  int64_t deadline_ns = 0;
  bool is_tracked = false;
  // Each part is paid by the one of them whose turn comes first, so that a picture that
  // several share costs each of them less. Empty = the server itself.
  Payers payers = {};
  std::string stream = {};
  std::string display = {};  // picture key; "" = structures of the stream
};

// Shares the time of engines out. One instance serves the device, the worker threads and the builds
// of structures: time on one of them counts on all.
//
// Order of two claims: the identity with the smaller share so far; of one identity, tracked eyes,
// which leave its other displays a quarter (EyesTurn); the stream with the smaller share; of one
// stream the display with the smaller share, or if they differ by no more than kInOrder_ns the
// sooner deadline. Thread-safety: all methods may be called from any thread.
class FairShares {
 public:
  // The item that goes next; nullptr = there is none. `claim_of` answers with a pointer to the
  // claim of an item, or nullptr where there is nothing to do for it. Items with equal claims keep
  // their order.
  template <typename Items, typename ClaimOf>
  auto next(const Items& items, const ClaimOf& claim_of) const {
    std::vector<const Claim*> claims;
    for (const auto& item : items) claims.push_back(claim_of(item));
    const std::optional<size_t> index = nextOf(claims);
    return index ? &*(items.begin() + std::ptrdiff_t(*index)) : nullptr;
  }
  // Place of the claim that goes next. Those that are nullptr do not count.
  std::optional<size_t> nextOf(const std::vector<const Claim*>& claims) const;
  // Whether the first goes before the second. Of equal claims none does.
  bool goesBefore(const Claim& first, const Claim& second) const;
  // Whether whoever pays for the first has had less so far than whoever does for the second.
  bool hasHadLess(const Claim& first, const Claim& second) const;

  // The claim begins to wait; its display had nothing to do before.
  void enter(const Claim& claim);
  // A piece of the claim's work begins, and will take about so long.
  void begin(const Claim& claim, int64_t predicted_ns);
  // The piece has taken so long. No more than kPaidMax times its prediction is paid, or those of
  // a whole piece: a driver may have compiled a kernel meanwhile.
  void finish(const Claim& claim, int64_t predicted_ns, int64_t measured_ns);

 private:
  // Virtual time of a payer.
  struct Node {
    int64_t finish_ns = 0;  // of all that it has begun
  };
  // Place of a payer among others; the least goes first. While a device serves a few, those who
  // share threads fall behind, and all begin with their credit. Then they go by turns, as if there
  // were no device.
  struct Place {
    int64_t start_ns = 0;
    int64_t finish_ns = 0;
    auto operator<=>(const Place&) const = default;
  };
  // Virtual time of the payers of one level: where the last one began that was served.
  struct Level {
    int64_t now_ns = 0;
    int64_t startOf(const Node& node) const;
    // Somebody new begins where the others are.
    int64_t startOf(const Node* node) const { return startOf(node == nullptr ? Node{} : *node); }
    // While it waits, a display keeps its place among those of its stream: see enter().
    int64_t placeOf(const Node* node) const {
      return node == nullptr ? startOf(node) : node->finish_ns;
    }
    void move(Node& node, int64_t time_ns);
  };
  struct Stream : Node {
    Level level;
    std::unordered_map<std::string, Node> displays;
  };
  struct Account : Node {
    EyesTurn eyes;
    Level level;
    std::unordered_map<std::string, Stream> streams;
  };
  // A claim by one of its payers.
  struct Candidate {
    size_t index = 0;
    const Claim* claim = nullptr;
    const Payer* payer = nullptr;
    Place place;
    int64_t start_ns = 0;  // of its stream among those of the payer, then of its display
  };

  const Account* find(const Payer& payer) const;
  Place placeOf(const Payer& payer) const;
  const Payer& payerOf(const Claim& claim) const;
  std::optional<size_t> choose(const std::vector<const Claim*>& claims) const;
  static void keepTurnOfEyes(const Account* account, std::vector<Candidate>& candidates);
  static void keepOneStream(const Account* account, std::vector<Candidate>& candidates);
  static void keepLeastDisplays(const Account* account, std::vector<Candidate>& candidates);
  void move(const Claim& claim, int64_t time_ns);
  Account& accountOf(const Payer& payer);
  static Stream& streamOf(Account& account, const Claim& claim);
  static Node& displayOf(Stream& stream, const Claim& claim);

  mutable std::mutex mutex_;  // guards what follows
  Level level_;
  std::map<Payer, Account> accounts_;
};

}  // namespace viewloom
