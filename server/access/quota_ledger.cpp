// SPDX-License-Identifier: Apache-2.0
#include "access/quota_ledger.h"

#include "access/quota_account.h"

namespace viewloom {

QuotaPart::QuotaPart(std::shared_ptr<QuotaAccount> account, QuotaKind kind, std::string key)
    : account_(std::move(account)), kind_(kind), key_(std::move(key)) {}

QuotaPart::~QuotaPart() {
  if (is_held_) account_->letGo(kind_, key_);
}

void QuotaPart::noteAtlas(uint64_t sequence, uint64_t pixels) const {
  account_->noteAtlas(key_, sequence, pixels);
}

// Accounts stay until what was used is drained: who leaves and comes back starts with nothing new.
std::shared_ptr<QuotaAccount> QuotaLedger::accountOf(const Identity& identity) {
  if (identity.rights.quota == Quota()) return nullptr;
  std::lock_guard lock(mutex_);
  const auto key = std::pair(identity.proof, identity.id);
  const auto found = accounts_.find(key);
  if (found != accounts_.end()) return found->second;
  // One that somebody is about to use has a second owner.
  std::erase_if(accounts_, [](const auto& entry) {
    return entry.second.use_count() == 1 && entry.second->isIdle();
  });
  return accounts_.emplace(key, std::make_shared<QuotaAccount>(identity.id, clock_)).first->second;
}

// The part is made before it is counted: there may be no memory for it.
template <typename Hold>
absl::StatusOr<QuotaPartPtr> QuotaLedger::held(const std::shared_ptr<QuotaAccount>& account,
                                               QuotaKind kind, std::string key, const Hold& hold) {
  const auto part = std::make_shared<QuotaPart>(account, kind, std::move(key));
  VIEWLOOM_RETURN_IF_ERROR(hold(part->key_));
  part->is_held_ = true;
  return part;
}

absl::StatusOr<QuotaPartPtr> QuotaLedger::holdConnection(const Identity& identity) {
  const std::shared_ptr<QuotaAccount> account = accountOf(identity);
  if (account == nullptr) return QuotaPartPtr();
  constexpr QuotaKind kKind = QuotaKind::kConnections;
  return held(account, kKind, account->takeConnectionKey(), [&](const std::string& key) {
    return account->hold(identity.rights.quota, kKind, key);
  });
}

absl::StatusOr<QuotaPartPtr> QuotaLedger::holdStream(const Identity& identity,
                                                     const std::string& name) {
  const std::shared_ptr<QuotaAccount> account = accountOf(identity);
  if (account == nullptr) return QuotaPartPtr();
  constexpr QuotaKind kKind = QuotaKind::kStreams;
  return held(account, kKind, name, [&](const std::string& key) {
    return account->hold(identity.rights.quota, kKind, key);
  });
}

absl::StatusOr<QuotaPartPtr> QuotaLedger::holdDisplay(const Identity& identity,
                                                      const DisplayUse& use,
                                                      const QuotaPart* replaced) {
  const std::shared_ptr<QuotaAccount> account = accountOf(identity);
  if (account == nullptr) return QuotaPartPtr();
  return held(account, QuotaKind::kDisplays, use.key, [&](const std::string&) {
    return account->holdDisplay(identity.rights.quota, use, replaced);
  });
}

void QuotaLedger::noteBytes(const Identity& identity, uint64_t bytes) {
  const std::shared_ptr<QuotaAccount> account = accountOf(identity);
  if (account != nullptr) account->noteBytes(identity.rights.quota, bytes);
}

absl::Status QuotaLedger::checkRates(const Identity& identity) {
  const std::shared_ptr<QuotaAccount> account = accountOf(identity);
  return account == nullptr ? absl::OkStatus()
                            : account->checkRates(identity.rights.quota, RateCheck::kRefuses);
}

absl::Status QuotaLedger::endIfOver(const Identity& identity) {
  const std::shared_ptr<QuotaAccount> account = accountOf(identity);
  return account == nullptr ? absl::OkStatus()
                            : account->checkRates(identity.rights.quota, RateCheck::kEnds);
}

}  // namespace viewloom
