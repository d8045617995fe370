// SPDX-License-Identifier: Apache-2.0
#include "admission/memory_budget.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "base/retry_delay.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr int64_t kRetryDelay_ns = 1'000'000'000;

uint64_t minusOrZero(uint64_t from, uint64_t bytes) {
  return from > bytes ? from - bytes : 0;
}

// The share of one identity in what all others leave.
uint64_t shareOf(uint64_t left_by_others) {
  return left_by_others - left_by_others / 4;
}

}  // namespace

struct Reservation::Ledger {
  explicit Ledger(uint64_t bytes) : total_bytes(bytes) {}

  const uint64_t total_bytes;
  mutable std::mutex mutex;  // guards what follows
  uint64_t reserved_bytes = 0;
  uint64_t peak_bytes = 0;  // since takePeakBytes()
  std::array<uint64_t, size_t(MemoryUse::kCount)> by_use{};
  std::map<std::string, uint64_t> by_identity;  // bytes; of those that have some
  std::vector<std::weak_ptr<IdleMemory>> idle;

  uint64_t leftFor(const std::string& identity, uint64_t idle_bytes) const {
    const uint64_t free_bytes = minusOrZero(total_bytes, reserved_bytes + idle_bytes);
    if (identity.empty()) return free_bytes;
    const auto found = by_identity.find(identity);
    const uint64_t own_bytes = found == by_identity.end() ? 0 : found->second;
    const uint64_t share = shareOf(free_bytes + own_bytes);
    return std::min(free_bytes, minusOrZero(share, own_bytes));
  }

  void add(const MemoryRequest& request) {
    if (!request.identity.empty() && request.bytes > 0) {
      by_identity[request.identity] += request.bytes;
    }
    reserved_bytes += request.bytes;
    peak_bytes = std::max(peak_bytes, reserved_bytes);
    by_use[size_t(request.use)] += request.bytes;
  }

  void remove(MemoryUse use, const std::string& identity, uint64_t bytes) {
    std::lock_guard lock(mutex);
    reserved_bytes -= bytes;
    by_use[size_t(use)] -= bytes;
    if (identity.empty()) return;
    const auto found = by_identity.find(identity);
    if ((found->second -= bytes) == 0) by_identity.erase(found);
  }

  std::vector<std::shared_ptr<IdleMemory>> livingIdle() {
    std::vector<std::shared_ptr<IdleMemory>> living;
    std::lock_guard lock(mutex);
    std::erase_if(idle, [&](const std::weak_ptr<IdleMemory>& weak) {
      std::shared_ptr<IdleMemory> alive = weak.lock();
      if (!alive) return true;
      living.push_back(std::move(alive));
      return false;
    });
    return living;
  }
};

Reservation::Reservation(std::shared_ptr<Ledger> ledger, const MemoryRequest& request)
    : ledger_(std::move(ledger)),
      use_(request.use),
      identity_(request.identity),
      bytes_(request.bytes) {}

void Reservation::swap(Reservation& other) noexcept {
  ledger_.swap(other.ledger_);
  std::swap(use_, other.use_);
  identity_.swap(other.identity_);
  std::swap(bytes_, other.bytes_);
}

void Reservation::shrinkTo(uint64_t bytes) {
  if (bytes >= bytes_) return;
  ledger_->remove(use_, identity_, bytes_ - bytes);
  bytes_ = bytes;
}

MemoryBudget::MemoryBudget(uint64_t total_bytes, OnRefused on_refused)
    : on_refused_(std::move(on_refused)),
      ledger_(std::make_shared<Reservation::Ledger>(total_bytes)) {}

std::optional<Reservation> MemoryBudget::grant(const MemoryRequest& request) {
  const uint64_t idle_bytes = idleBytes();
  // Made before it is counted: what it takes itself may not be there.
  Reservation granted(ledger_, {request.use, request.identity, 0});
  std::lock_guard lock(ledger_->mutex);
  if (request.bytes > ledger_->leftFor(request.identity, idle_bytes)) return std::nullopt;
  ledger_->add(request);
  granted.bytes_ = request.bytes;
  return granted;
}

std::optional<Reservation> MemoryBudget::tryReserve(const MemoryRequest& request) {
  std::optional<Reservation> granted = grant(request);
  if (!granted && mayEverFit(request)) {
    releaseIdle(std::chrono::nanoseconds(0));
    granted = grant(request);
  }
  if (!granted) on_refused_(request.use);
  return granted;
}

absl::StatusOr<Reservation> MemoryBudget::reserve(const MemoryRequest& request,
                                                  std::string_view what,
                                                  const WhatFits& what_fits) {
  if (std::optional<Reservation> granted = tryReserve(request)) return *std::move(granted);
  const uint64_t left_bytes = leftFor(request.identity);
  const std::string fitting = what_fits(left_bytes);
  const bool fits_alone = request.bytes <= mostForOne();
  const absl::Status refusal = absl::ResourceExhaustedError(strCat(
      what, " takes ", memoryText(request.bytes), " of memory; ", memoryText(left_bytes),
      " of the server's ", memoryText(ledger_->total_bytes), " (memory.budget) are left for ",
      request.identity.empty() ? "it" : request.identity, ". ",
      fitting.empty() ? std::string("Nothing smaller fits") : fitting,
      fits_alone ? ". End something else, or try again later" : ". For more, raise memory.budget"));
  return fits_alone ? worthRetry(refusal, kRetryDelay_ns) : refusal;
}

Reservation MemoryBudget::charge(MemoryUse use, uint64_t bytes) {
  const MemoryRequest request{.use = use, .bytes = bytes};
  Reservation charged(ledger_, {.use = use});
  std::lock_guard lock(ledger_->mutex);
  ledger_->add(request);
  charged.bytes_ = bytes;
  return charged;
}

uint64_t MemoryBudget::leftFor(const std::string& identity) const {
  const uint64_t idle_bytes = idleBytes();
  std::lock_guard lock(ledger_->mutex);
  return ledger_->leftFor(identity, idle_bytes);
}

uint64_t MemoryBudget::mostForOne() const {
  const uint64_t fixed_bytes =
      reservedBytes(MemoryUse::kProgram) + reservedBytes(MemoryUse::kMessages);
  return shareOf(minusOrZero(ledger_->total_bytes, fixed_bytes));
}

bool MemoryBudget::mayEverFit(const MemoryRequest& request) const {
  return request.bytes <= (request.identity.empty() ? ledger_->total_bytes : mostForOne());
}

void MemoryBudget::addIdle(const std::shared_ptr<IdleMemory>& idle) {
  std::lock_guard lock(ledger_->mutex);
  ledger_->idle.push_back(idle);
}

uint64_t MemoryBudget::releaseIdle(std::chrono::nanoseconds unused_for) {
  uint64_t released_bytes = 0;
  for (const std::shared_ptr<IdleMemory>& idle : ledger_->livingIdle()) {
    released_bytes += idle->releaseIdle(unused_for);
  }
  return released_bytes;
}

uint64_t MemoryBudget::totalBytes() const {
  return ledger_->total_bytes;
}

uint64_t MemoryBudget::reservedBytes() const {
  std::lock_guard lock(ledger_->mutex);
  return ledger_->reserved_bytes;
}

uint64_t MemoryBudget::reservedBytes(MemoryUse use) const {
  std::lock_guard lock(ledger_->mutex);
  return ledger_->by_use[size_t(use)];
}

uint64_t MemoryBudget::idleBytes() const {
  uint64_t idle_bytes = 0;
  for (const std::shared_ptr<IdleMemory>& idle : ledger_->livingIdle()) {
    idle_bytes += idle->idleBytes();
  }
  return idle_bytes;
}

uint64_t MemoryBudget::takePeakBytes() {
  std::lock_guard lock(ledger_->mutex);
  return std::exchange(ledger_->peak_bytes, ledger_->reserved_bytes);
}

MemoryBudget& unboundedMemory() {
  static MemoryBudget unbounded(uint64_t{1} << 62);
  return unbounded;
}

std::string memoryText(uint64_t bytes) {
  constexpr std::array kUnits{"bytes", "kB", "MB", "GB", "TB"};
  size_t unit = 0;
  auto amount = double(bytes);
  while (amount >= 999.5 && unit + 1 < kUnits.size()) {
    amount /= 1000;
    ++unit;
  }
  std::array<char, 32> text{};
  const int decimals = unit >= 3 && amount < 99.5 ? 2 : 0;
  std::snprintf(text.data(), text.size(), "%.*f %s", decimals, amount, kUnits[unit]);
  return text.data();
}

}  // namespace viewloom
