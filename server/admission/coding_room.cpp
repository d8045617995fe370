// SPDX-License-Identifier: Apache-2.0
#include "admission/coding_room.h"

namespace viewloom {
namespace {

constexpr int64_t kLookedAt_ns = 2'000'000'000;
// A load is known of so long a time.
constexpr int64_t kKnownLoad_ns = 1'000'000'000;
// Share of the cores that may be taken with another encoding. The rest is for what comes in bursts.
constexpr double kGrantedLoad = 0.8;
// From this load on, for so long, others wait.
constexpr double kFullLoad = 0.95;
constexpr int64_t kFull_ns = 3'000'000'000;

}  // namespace

void CodingRoom::look(int64_t now_ns) {
  if (core_count_ <= 0) return;
  const int64_t used_ns = used_ns_();
  std::lock_guard lock(mutex_);
  looks_.push_back({now_ns, used_ns});
  while (looks_.front().at_ns < now_ns - kLookedAt_ns) looks_.pop_front();
  is_over_ = full_.note(load().value_or(0) >= kFullLoad, now_ns) >= kFull_ns;
}

std::optional<double> CodingRoom::load() const {
  if (looks_.empty()) return std::nullopt;
  const int64_t time_ns = looks_.back().at_ns - looks_.front().at_ns;
  if (time_ns < kKnownLoad_ns) return std::nullopt;
  const int64_t used_ns = looks_.back().used_ns - looks_.front().used_ns;
  return double(used_ns) / (double(time_ns) * core_count_);
}

bool CodingRoom::take(double busy_core_count, int64_t now_ns) {
  std::lock_guard lock(mutex_);
  const std::optional<double> taken = load();
  const bool shows = !taken_ns_ || now_ns - *taken_ns_ > kLookedAt_ns;
  if (!taken || !shows || *taken + busy_core_count / core_count_ > kGrantedLoad) return false;
  taken_ns_ = now_ns;
  return true;
}

void CodingRoom::giveBack() {
  std::lock_guard lock(mutex_);
  taken_ns_.reset();
}

bool CodingRoom::isOver() const {
  std::lock_guard lock(mutex_);
  return is_over_;
}

CodingRoom& noCodingRoom() {
  static CodingRoom none(0, [] { return int64_t{0}; });
  return none;
}

}  // namespace viewloom
