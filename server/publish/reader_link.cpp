// SPDX-License-Identifier: Apache-2.0
#include "publish/reader_link.h"

#include <algorithm>
#include <utility>

namespace viewloom {
namespace {

constexpr int64_t kLinkWindow_ns = 1'000'000'000;
// Enough for 120 atlases a second over the window.
constexpr size_t kDeliveriesMax = 128;
// An atlas that keeps the socket busy for so long tells the speed by itself. Shorter waits may come
// from a busy processor.
constexpr int64_t kTelling_ns = 80'000'000;
// Busy time in the window from which on it tells the speed.
constexpr int64_t kKnown_ns = 100'000'000;

double rateOf(uint64_t bytes, int64_t busy_ns) {
  return double(bytes) * 1e9 / double(std::max<int64_t>(busy_ns, 1));
}

}  // namespace

void ReaderLink::beginWrite(uint64_t bytes, int64_t now_ns) {
  write_bytes_ = bytes;
  write_begun_ns_ = now_ns;
}

void ReaderLink::endWrite(int64_t now_ns) {
  if (!isWriting()) return;
  current_ = current(now_ns);
  write_begun_ns_ = kIdle;
  write_bytes_ = 0;
}

void ReaderLink::endAtlas(int64_t now_ns) {
  endWrite(now_ns);
  current_.done_ns = now_ns;
  deliveries_.push_back(std::exchange(current_, {}));
  while (deliveries_.size() > kDeliveriesMax ||
         deliveries_.front().done_ns < now_ns - kLinkWindow_ns) {
    deliveries_.pop_front();
  }
}

ReaderLink::Delivery ReaderLink::current(int64_t now_ns) const {
  Delivery current = current_;
  current.done_ns = now_ns;
  if (!isWriting()) return current;
  current.bytes += write_bytes_;
  current.busy_ns += std::max<int64_t>(now_ns - write_begun_ns_, 0);
  return current;
}

ReaderLink::Delivery ReaderLink::recent(int64_t now_ns) const {
  Delivery recent = current(now_ns);
  for (const Delivery& delivery : deliveries_) {
    if (delivery.done_ns < now_ns - kLinkWindow_ns) continue;
    recent.bytes += delivery.bytes;
    recent.busy_ns += delivery.busy_ns;
  }
  return recent;
}

std::optional<double> ReaderLink::bytesPerSecond(int64_t now_ns) const {
  const Delivery all = recent(now_ns);
  std::optional<double> speed;
  if (all.busy_ns >= kKnown_ns) speed = rateOf(all.bytes, all.busy_ns);
  Delivery newest = current(now_ns);
  const bool is_recent =
      !deliveries_.empty() && deliveries_.back().done_ns >= now_ns - kLinkWindow_ns;
  if (newest.busy_ns < kTelling_ns && is_recent) newest = deliveries_.back();
  if (newest.busy_ns < kTelling_ns) return speed;
  const double of_newest = rateOf(newest.bytes, newest.busy_ns);
  return speed ? std::min(*speed, of_newest) : of_newest;
}

uint64_t ReaderLink::recentBytes(int64_t now_ns) const {
  return recent(now_ns).bytes;
}

}  // namespace viewloom
