// SPDX-License-Identifier: Apache-2.0
#include "publish/reader_rung.h"

#include <algorithm>

namespace viewloom {
namespace {

// A reader that leaves the first rung again within twice the wait has come back in vain.
constexpr int64_t kVainWaits = 2;
// The longest wait before a return, in the usual ones.
constexpr int64_t kWaitsMax = 8;
// A line that shows no limit on the second rung may still be too slow for the first: it is tried,
// after so many times the wait before a return that is known to fit.
constexpr int64_t kTryWaits = 8;

}  // namespace

bool ReaderRung::wantsOther(LineFit first, int64_t now_ns) {
  const bool fits = first == LineFit::kFits;
  const int64_t far_ns = far_.note(first == LineFit::kFar, now_ns);
  const int64_t fits_ns = fits_.note(fits, now_ns);
  const int64_t unlimited_ns = shows_no_limit_.note(fits || first == LineFit::kUnknown, now_ns);
  const bool wants = rung_ == VideoRung::kFirst ? far_ns >= kWait_ns
                                                : fits_ns >= return_wait_ns_ ||
                                                      unlimited_ns >= kTryWaits * return_wait_ns_;
  if (wants) restartSpells();
  return wants;
}

void ReaderRung::noteMoved(int64_t now_ns) {
  restartSpells();
  if (rung_ == VideoRung::kSecond) {
    rung_ = VideoRung::kFirst;
    returned_ns_ = now_ns;
    return;
  }
  rung_ = VideoRung::kSecond;
  const bool was_in_vain =
      returned_ns_ != kNever_ns && now_ns - returned_ns_ < kVainWaits * kWait_ns;
  return_wait_ns_ = was_in_vain ? std::min(2 * return_wait_ns_, kWaitsMax * kWait_ns) : kWait_ns;
}

void ReaderRung::restartSpells() {
  far_ = fits_ = shows_no_limit_ = {};
}

}  // namespace viewloom
