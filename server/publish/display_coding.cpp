// SPDX-License-Identifier: Apache-2.0
#include "publish/display_coding.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

namespace viewloom {
namespace {

// Without an atlas for so long, and for twice the time between the last two, frames stand; at the
// latest after so long, as with publishers that send a frame now and then.
constexpr int64_t kStanding_ns = 500'000'000;
constexpr int64_t kStandingMax_ns = 3'000'000'000;

QualityRange rangeOf(const EncodingSpec& encoding) {
  return {.finest_qp = encoding.video_qp,
          .coarsest_qp = std::max(encoding.video_qp, encoding.video_qp_max),
          .bits_per_second_max = encoding.bits_per_second_max};
}

// The larger one of the two in the middle of an even count. Expects one value at least.
double upperMedian(std::vector<double>& values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

DisplayCoding::DisplayCoding(const EncodingSpec& encoding)
    : range_(rangeOf(encoding)), rung_(range_) {}

std::shared_ptr<DisplayCoding> DisplayCoding::otherRung() const {
  std::lock_guard lock(mutex_);
  return std::make_shared<DisplayCoding>(range_, rung_);
}

ReaderLine DisplayCoding::newLine() const {
  return {.link = {}, .allowance = RateAllowance(range_.bits_per_second_max), .rung = {}};
}

void DisplayCoding::join(uint64_t reader, const Payer& client,
                         const std::optional<ReaderLine>& line) {
  std::lock_guard lock(mutex_);
  readers_.try_emplace(reader, Reader{.client = client, .line = line ? *line : newLine()});
}

void DisplayCoding::leave(uint64_t reader) {
  std::lock_guard lock(mutex_);
  readers_.erase(reader);
}

void DisplayCoding::beginWrite(uint64_t reader, uint64_t bytes, int64_t now_ns) {
  std::lock_guard lock(mutex_);
  const auto found = readers_.find(reader);
  if (found == readers_.end()) return;
  found->second.line.link.beginWrite(bytes, now_ns);
  found->second.line.allowance.note(bytes, now_ns);
}

void DisplayCoding::endWrite(uint64_t reader, int64_t now_ns) {
  std::lock_guard lock(mutex_);
  const auto found = readers_.find(reader);
  if (found != readers_.end()) found->second.line.link.endWrite(now_ns);
}

void DisplayCoding::endAtlas(uint64_t reader, int64_t now_ns) {
  std::lock_guard lock(mutex_);
  const auto found = readers_.find(reader);
  if (found != readers_.end()) found->second.line.link.endAtlas(now_ns);
}

bool DisplayCoding::mayBegin(uint64_t reader, int64_t now_ns) const {
  if (range_.bits_per_second_max == 0) return true;
  std::lock_guard lock(mutex_);
  const auto found = readers_.find(reader);
  if (found == readers_.end()) return true;
  return found->second.line.link.recentBytes(now_ns) * 8 < range_.bits_per_second_max &&
         found->second.line.allowance.isOpen(now_ns);
}

ReaderLine DisplayCoding::lineOf(uint64_t reader) const {
  std::lock_guard lock(mutex_);
  const auto found = readers_.find(reader);
  return found == readers_.end() ? newLine() : found->second.line;
}

LineSpeed DisplayCoding::speedOf(uint64_t reader, int64_t now_ns) const {
  std::lock_guard lock(mutex_);
  const auto found = readers_.find(reader);
  if (found == readers_.end()) return {};
  const ReaderLink& link = found->second.line.link;
  return {.bytes_per_second = link.bytesPerSecond(now_ns),
          .recent_bytes = link.recentBytes(now_ns)};
}

uint32_t DisplayCoding::qp() const {
  std::lock_guard lock(mutex_);
  return rung_.qp();
}

LineFit DisplayCoding::fitOf(const LineSpeed& speed, int64_t now_ns) const {
  std::lock_guard lock(mutex_);
  return rung_.fitOf(speed, now_ns);
}

bool DisplayCoding::wantsOtherRung(uint64_t reader, LineFit first, int64_t now_ns) {
  std::lock_guard lock(mutex_);
  const auto found = readers_.find(reader);
  return found != readers_.end() && found->second.line.rung.wantsOther(first, now_ns);
}

uint32_t DisplayCoding::beginAtlas(int64_t now_ns) {
  std::lock_guard lock(mutex_);
  return begin(range_.coarsest_qp, now_ns);
}

uint32_t DisplayCoding::beginAgain(int64_t now_ns) {
  std::lock_guard lock(mutex_);
  return begin(last_qp_ != 0 ? last_qp_ : range_.coarsest_qp, now_ns);
}

uint32_t DisplayCoding::begin(uint32_t qp_max, int64_t now_ns) {
  if (last_qp_ != 0) apart_ns_ = now_ns - begun_ns_;
  begun_ns_ = now_ns;
  rung_.noteBegun(now_ns);
  rung_.adapt(medianSpeed(now_ns), now_ns);
  const bool is_finest = std::exchange(is_wanted_, false);
  last_qp_ = std::min(rung_.qp(), is_finest ? rung_.finestAlone() : qp_max);
  return last_qp_;
}

void DisplayCoding::noteCoded(uint32_t qp, uint64_t bytes) {
  std::lock_guard lock(mutex_);
  rung_.noteCoded(qp, bytes);
}

void DisplayCoding::noteCodingTime(int64_t time_ns) {
  std::lock_guard lock(mutex_);
  coding_ns_ = time_ns;
}

std::optional<double> DisplayCoding::busyCoreCount(int64_t now_ns) const {
  std::lock_guard lock(mutex_);
  if (coding_ns_ == 0) return std::nullopt;
  return double(rung_.atlasesPerSecond(now_ns)) * double(coding_ns_) * 1e-9;
}

bool DisplayCoding::wantsFiner(int64_t now_ns) {
  std::lock_guard lock(mutex_);
  const bool is_coarse = last_qp_ > rung_.finestAlone();
  const int64_t standing_ns = std::clamp(2 * apart_ns_, kStanding_ns, kStandingMax_ns);
  const bool do_stand = now_ns - begun_ns_ >= standing_ns;
  if (is_wanted_ || !is_coarse || !do_stand || !isIdle()) return false;
  is_wanted_ = true;
  return true;
}

bool DisplayCoding::isWanted() const {
  std::lock_guard lock(mutex_);
  return is_wanted_;
}

template <typename ValueOf>
std::optional<double> DisplayCoding::median(const ValueOf& value_of) const {
  std::map<std::string_view, std::vector<double>> of_clients;
  for (const auto& [number, reader] : readers_) {
    const std::optional<double> value = value_of(reader.line.link);
    if (value) of_clients[reader.client.name()].push_back(*value);
  }
  if (of_clients.empty()) return std::nullopt;
  std::vector<double> medians;
  medians.reserve(of_clients.size());
  for (auto& [client, values] : of_clients) medians.push_back(upperMedian(values));
  return upperMedian(medians);
}

// Readers without a limit are faster than all others.
std::optional<double> DisplayCoding::medianSpeed(int64_t now_ns) const {
  const std::optional<double> speed = median([&](const ReaderLink& link) -> std::optional<double> {
    if (link.recentBytes(now_ns) == 0) return std::nullopt;
    return link.bytesPerSecond(now_ns).value_or(HUGE_VAL);
  });
  return speed && std::isinf(*speed) ? std::nullopt : speed;
}

// One client that takes nothing does not hold the others back, as with the median.
bool DisplayCoding::isIdle() const {
  constexpr double kIdle = 1;
  const std::optional<double> idle = median(
      [](const ReaderLink& link) -> std::optional<double> { return link.isWriting() ? 0 : kIdle; });
  return idle.value_or(kIdle) == kIdle;
}

}  // namespace viewloom
