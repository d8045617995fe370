// SPDX-License-Identifier: Apache-2.0
#include "access/quota_account.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_format.h"
#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr double kNanosecond_s = 1e-9;
constexpr double kPixelRateLeast_hz = 1;

struct CountedLimit {
  const char* name;   // in the token file
  const char* one;    // of them
  const char* field;  // that asks for one; "" = none does
  std::optional<uint64_t> Quota::*value;
};
// In the order of QuotaKind.
constexpr std::array<CountedLimit, size_t(QuotaKind::kCount)> kCounted = {{
    {"connections", "connection", "", &Quota::connections},
    {"streams", "stream", "stream", &Quota::streams},
    {"displays", "display", "", &Quota::displays},
}};

constexpr const char* kOperator = "The operator of the server can raise the limit";

absl::Status exhausted(const char* field, const std::string& message) {
  if (*field == '\0') return absl::ResourceExhaustedError(message);
  return fieldError(absl::StatusCode::kResourceExhausted, field, message);
}

double pixelsPerSecond(const DisplayUse& use) {
  return double(use.pixels) * std::max(use.rate_hz, kPixelRateLeast_hz);
}

// The rate, or the size, with which the display fits into what is left.
std::string fittingDisplay(const DisplayUse& use, double left_per_s) {
  const double rate_hz = std::floor(10 * left_per_s / double(use.pixels)) / 10;
  const double side = std::floor(100 * std::sqrt(left_per_s / pixelsPerSecond(use)));
  if (side < 1) return "Nothing smaller fits";
  const std::string smaller = absl::StrFormat("with %.0f %% of its width and height", side);
  if (rate_hz < kPixelRateLeast_hz) return strCat("Such a display fits ", smaller);
  return strCat("Such a display fits at up to ", absl::StrFormat("%.1f", rate_hz),
                " pictures a second (temporal.output_rate_hz), or ", smaller);
}

}  // namespace

void RateMeter::drain(double per_s, int64_t now_ns) {
  level_ = std::max(0.0, level_ - per_s * kNanosecond_s * double(now_ns - drained_ns_));
  drained_ns_ = now_ns;
  if (level_ > 0) return;
  used_ = 0;
  since_ns_ = now_ns;
}

void RateMeter::note(double amount, double per_s, int64_t now_ns) {
  drain(per_s, now_ns);
  level_ += amount;
  used_ += amount;
}

bool RateMeter::isOver(double per_s, int64_t now_ns) {
  drain(per_s, now_ns);
  const bool is_over = level_ > per_s * double(QuotaLedger::kBurst_s);
  if (!is_over) excused_ = 0;
  return is_over;
}

bool RateMeter::isOverAgain(double per_s, int64_t now_ns) {
  return isOver(per_s, now_ns) && level_ > excused_;
}

void RateMeter::excuse(double per_s) {
  excused_ = level_ + per_s * double(QuotaLedger::kBurst_s);
}

bool RateMeter::isEmpty(double per_s, int64_t now_ns) {
  drain(per_s, now_ns);
  return level_ == 0;
}

std::string QuotaAccount::limitText(const char* limit) const {
  return strCat("(limit ", limit, " of the access token of \"", printable(id_), "\")");
}

const QuotaAccount::Held* QuotaAccount::goingWith(const QuotaPart* replaced) {
  if (replaced == nullptr || replaced->account_.get() != this) return nullptr;
  const Held& held = heldOf(replaced->kind_).at(replaced->key_);
  return held.holder_count == 1 ? &held : nullptr;
}

absl::Status QuotaAccount::checkCount(const Quota& quota, QuotaKind kind, const std::string& key,
                                      const QuotaPart* replaced) {
  const CountedLimit& limit = kCounted[size_t(kind)];
  const std::optional<uint64_t>& most = quota.*(limit.value);
  if (!most || heldOf(kind).contains(key)) return absl::OkStatus();
  const uint64_t held_count = heldOf(kind).size() - (goingWith(replaced) == nullptr ? 0 : 1);
  if (held_count < *most) return absl::OkStatus();
  return exhausted(limit.field,
                   strCat("a further ", limit.one, " was asked for; accepted are ", *most,
                          " at a time ", limitText(limit.name), ", and there are ", held_count,
                          ". ", held_count > 0 ? "End one of them first. " : "", kOperator));
}

absl::Status QuotaAccount::checkPixels(const Quota& quota, const DisplayUse& use,
                                       const QuotaPart* replaced) {
  if (!quota.pixels_per_s || heldOf(QuotaKind::kDisplays).contains(use.key)) {
    return absl::OkStatus();
  }
  double left_per_s = double(*quota.pixels_per_s);
  for (const auto& [key, held] : heldOf(QuotaKind::kDisplays)) left_per_s -= held.pixels_per_s;
  if (const Held* const going = goingWith(replaced)) left_per_s += going->pixels_per_s;
  left_per_s = std::max(0.0, left_per_s);
  const double asked_per_s = pixelsPerSecond(use);
  if (asked_per_s <= left_per_s) return absl::OkStatus();
  return absl::ResourceExhaustedError(
      strCat("the display asks for ", absl::StrFormat("%.0f", asked_per_s), " pixels a second (",
             use.pixels, " in each picture); ", absl::StrFormat("%.0f", left_per_s), " of ",
             *quota.pixels_per_s, " are left ", limitText("pixels_per_s"), ". ",
             fittingDisplay(use, left_per_s), ". ", kOperator));
}

absl::Status QuotaAccount::hold(const Quota& quota, QuotaKind kind, const std::string& key) {
  std::lock_guard lock(mutex_);
  quota_ = quota;
  VIEWLOOM_RETURN_IF_ERROR(checkCount(quota, kind, key, nullptr));
  ++heldOf(kind)[key].holder_count;
  return absl::OkStatus();
}

absl::Status QuotaAccount::holdDisplay(const Quota& quota, const DisplayUse& use,
                                       const QuotaPart* replaced) {
  std::lock_guard lock(mutex_);
  quota_ = quota;
  VIEWLOOM_RETURN_IF_ERROR(checkCount(quota, QuotaKind::kDisplays, use.key, replaced));
  VIEWLOOM_RETURN_IF_ERROR(checkPixels(quota, use, replaced));
  Held& held = heldOf(QuotaKind::kDisplays)[use.key];
  if (held.holder_count++ == 0) held.pixels_per_s = pixelsPerSecond(use);
  return absl::OkStatus();
}

std::string QuotaAccount::takeConnectionKey() {
  std::lock_guard lock(mutex_);
  return strCat(++connection_number_);
}

void QuotaAccount::noteBytes(const Quota& quota, uint64_t bytes) {
  std::lock_guard lock(mutex_);
  quota_ = quota;
  if (quota.bytes_per_s) bytes_.note(double(bytes), double(*quota.bytes_per_s), clock_.nowNs());
}

void QuotaAccount::noteAtlas(const std::string& key, uint64_t sequence, uint64_t pixels) {
  std::lock_guard lock(mutex_);
  Held& held = heldOf(QuotaKind::kDisplays).at(key);
  if (sequence <= held.last_sequence) return;
  held.last_sequence = sequence;
  if (!quota_.pixels_per_s) return;
  pixels_.note(double(pixels), double(*quota_.pixels_per_s), clock_.nowNs());
}

absl::Status QuotaAccount::checkRate(RateMeter& meter, const std::optional<uint64_t>& per_s,
                                     const char* limit, const char* unit, RateCheck check) {
  const int64_t now_ns = clock_.nowNs();
  if (!per_s) return absl::OkStatus();
  const bool ends = check == RateCheck::kEnds;
  const bool is_over =
      ends ? meter.isOverAgain(double(*per_s), now_ns) : meter.isOver(double(*per_s), now_ns);
  if (!is_over) return absl::OkStatus();
  const absl::Status refusal = absl::ResourceExhaustedError(
      strCat(absl::StrFormat("%.0f", meter.used()), " ", unit, " were used within ",
             absl::StrFormat("%.1f", kNanosecond_s * double(now_ns - meter.sinceNs())),
             " s; accepted are ", *per_s, " a second ", limitText(limit),
             ". Send or ask for smaller pictures, or fewer a second. ", kOperator));
  if (ends) meter.excuse(double(*per_s));
  return refusal;
}

absl::Status QuotaAccount::checkRates(const Quota& quota, RateCheck check) {
  std::lock_guard lock(mutex_);
  quota_ = quota;
  VIEWLOOM_RETURN_IF_ERROR(checkRate(pixels_, quota.pixels_per_s, "pixels_per_s", "pixels", check));
  return checkRate(bytes_, quota.bytes_per_s, "bytes_per_s", "bytes", check);
}

bool QuotaAccount::isIdle() {
  std::lock_guard lock(mutex_);
  const int64_t now_ns = clock_.nowNs();
  const bool holds_nothing =
      std::ranges::all_of(held_, [](const HeldByKey& held) { return held.empty(); });
  return holds_nothing && pixels_.isEmpty(double(quota_.pixels_per_s.value_or(0)), now_ns) &&
         bytes_.isEmpty(double(quota_.bytes_per_s.value_or(0)), now_ns);
}

void QuotaAccount::letGo(QuotaKind kind, const std::string& key) {
  std::lock_guard lock(mutex_);
  const auto found = heldOf(kind).find(key);
  if (--found->second.holder_count == 0) heldOf(kind).erase(found);
}

}  // namespace viewloom
