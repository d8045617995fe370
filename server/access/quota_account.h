// SPDX-License-Identifier: Apache-2.0
// The use that one identity makes of its quota.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "access/quota_ledger.h"

namespace viewloom {

// A rate that is used in bursts. Thread-safety: none.
class RateMeter {
 public:
  void note(double amount, double per_s, int64_t now_ns);
  // Whether more than the rate, and QuotaLedger::kBurst_s seconds of it at once, was used.
  bool isOver(double per_s, int64_t now_ns);
  bool isEmpty(double per_s, int64_t now_ns);
  // Whether it is over, and as much again was used since the last time that it was excused. What is
  // excused stays used.
  bool isOverAgain(double per_s, int64_t now_ns);
  void excuse(double per_s);

  // Amount since the meter was empty last, and when that was.
  double used() const { return used_; }
  int64_t sinceNs() const { return since_ns_; }

 private:
  void drain(double per_s, int64_t now_ns);

  double level_ = 0;    // above the rate
  double excused_ = 0;  // up to this level; 0 = it was not over since
  double used_ = 0;
  int64_t since_ns_ = 0;
  int64_t drained_ns_ = 0;
};

// The end of a call when a rate is exceeded: of one that comes, or of one that lives.
enum class RateCheck : uint8_t {
  kRefuses,  // it does not begin
  kEnds      // it ends, and others live on
};

// Thread-safety: all methods may be called from any thread.
class QuotaAccount {
 public:
  // `clock` outlives it.
  QuotaAccount(std::string id, const Clock& clock) : id_(std::move(id)), clock_(clock) {}

  // See QuotaLedger; `quota` is the one in force now.
  absl::Status hold(const Quota& quota, QuotaKind kind, const std::string& key);
  absl::Status holdDisplay(const Quota& quota, const DisplayUse& use, const QuotaPart* replaced);
  std::string takeConnectionKey();
  void noteBytes(const Quota& quota, uint64_t bytes);
  absl::Status checkRates(const Quota& quota, RateCheck check);
  // Nothing is held, and nothing is left of what was used.
  bool isIdle();

  void letGo(QuotaKind kind, const std::string& key);
  void noteAtlas(const std::string& key, uint64_t sequence, uint64_t pixels);

 private:
  struct Held {
    uint64_t holder_count = 0;
    double pixels_per_s = 0;     // of a display, as it was admitted
    uint64_t last_sequence = 0;  // of its atlases
  };
  using HeldByKey = std::map<std::string, Held>;

  HeldByKey& heldOf(QuotaKind kind) { return held_[size_t(kind)]; }
  absl::Status checkCount(const Quota& quota, QuotaKind kind, const std::string& key,
                          const QuotaPart* replaced);
  absl::Status checkPixels(const Quota& quota, const DisplayUse& use, const QuotaPart* replaced);
  absl::Status checkRate(RateMeter& meter, const std::optional<uint64_t>& per_s, const char* limit,
                         const char* unit, RateCheck check);
  // The display that goes with `replaced`; null if others hold it, too.
  const Held* goingWith(const QuotaPart* replaced);
  std::string limitText(const char* limit) const;

  const std::string id_;
  const Clock& clock_;
  std::mutex mutex_;
  std::array<HeldByKey, size_t(QuotaKind::kCount)> held_;
  Quota quota_;  // the one used last
  uint64_t connection_number_ = 0;
  RateMeter pixels_;
  RateMeter bytes_;
};

}  // namespace viewloom
