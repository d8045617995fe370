// SPDX-License-Identifier: Apache-2.0
// The use that each identity makes of its quota.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "access/identity.h"
#include "base/clock.h"
#include "base/status.h"

namespace viewloom {

enum class QuotaKind : uint8_t { kConnections, kStreams, kDisplays, kCount };

// A display that an identity wants to watch.
struct DisplayUse {
  std::string key;      // displays with the same key are made once
  uint64_t pixels = 0;  // of one atlas
  double rate_hz = 0;   // atlases a second; less than 1 counts as 1, also when it is not known yet
};

class QuotaAccount;

// A part of a quota, given back by the destructor. May outlive the ledger. Thread-safety: const
// methods may be called from any thread.
class QuotaPart {
 public:
  QuotaPart(std::shared_ptr<QuotaAccount> account, QuotaKind kind, std::string key);
  ~QuotaPart();
  QuotaPart(const QuotaPart&) = delete;
  QuotaPart& operator=(const QuotaPart&) = delete;

  // An atlas of the display was made. Atlases with a number that was noted before do not count.
  void noteAtlas(uint64_t sequence, uint64_t pixels) const;

 private:
  friend class QuotaAccount;
  friend class QuotaLedger;

  const std::shared_ptr<QuotaAccount> account_;
  const QuotaKind kind_;
  const std::string key_;
  bool is_held_ = false;
};

// Null = the identity has no quota.
using QuotaPartPtr = std::shared_ptr<const QuotaPart>;

// Identities without a quota are granted everything. Refusals are RESOURCE_EXHAUSTED; they name the
// limit, and say what was asked and what fits. Thread-safety: all methods may be called from any
// thread.
class QuotaLedger {
 public:
  // Seconds of a rate that may be used at once, above the rate.
  static constexpr int64_t kBurst_s = 5;

  // `clock` outlives it.
  explicit QuotaLedger(const Clock& clock) : clock_(clock) {}

  absl::StatusOr<QuotaPartPtr> holdConnection(const Identity& identity);
  // Publishing one name twice takes one part.
  absl::StatusOr<QuotaPartPtr> holdStream(const Identity& identity, const std::string& name);
  // `replaced`: given back right after it, and so not counted; null = nothing.
  absl::StatusOr<QuotaPartPtr> holdDisplay(const Identity& identity, const DisplayUse& use,
                                           const QuotaPart* replaced);

  // Bytes that came from the identity's clients, or went to them.
  void noteBytes(const Identity& identity, uint64_t bytes);
  // Whether the identity keeps to its rates.
  absl::Status checkRates(const Identity& identity);
  // The same for a call that ends if it does not. Its other calls stay, until as much again was
  // used; new ones wait until the rate has fallen.
  absl::Status endIfOver(const Identity& identity);

 private:
  // Null = the identity has no quota.
  std::shared_ptr<QuotaAccount> accountOf(const Identity& identity);
  template <typename Hold>
  absl::StatusOr<QuotaPartPtr> held(const std::shared_ptr<QuotaAccount>& account, QuotaKind kind,
                                    std::string key, const Hold& hold);

  const Clock& clock_;
  std::mutex mutex_;
  std::map<std::pair<Proof, std::string>, std::shared_ptr<QuotaAccount>> accounts_;
};

}  // namespace viewloom
