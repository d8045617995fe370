// SPDX-License-Identifier: Apache-2.0
#include "base/rare_log.h"

#include <utility>

#include "base/str_cat.h"

namespace viewloom {

std::optional<std::string> RareLog::take(const std::string& line, int64_t now_ns) {
  std::lock_guard lock(mutex_);
  if (last_ns_ && now_ns - *last_ns_ < pause_ns_) {
    ++left_out_count_;
    return std::nullopt;
  }
  last_ns_ = now_ns;
  const uint64_t left_out_count = std::exchange(left_out_count_, 0);
  if (left_out_count == 0) return line;
  return strCat(line, " (", left_out_count, " such lines before it were left out)");
}

}  // namespace viewloom
