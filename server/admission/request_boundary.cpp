// SPDX-License-Identifier: Apache-2.0
#include "admission/request_boundary.h"

#include <new>
#include <optional>
#include <string>

#include "admission/out_of_memory.h"
#include "base/log.h"
#include "base/printable.h"
#include "base/rare_log.h"
#include "base/str_cat.h"
#include "base/thread_time.h"

namespace viewloom {
namespace {

constexpr std::chrono::seconds kLogPause{1};

bool isLackOfMemory(const std::exception& thrown) {
  return dynamic_cast<const std::bad_alloc*>(&thrown) != nullptr;
}

}  // namespace

void noteThrown(std::string_view work, const std::exception& thrown) noexcept {
  if (isLackOfMemory(thrown)) return;
  try {
    static RareLog rare(kLogPause);
    const std::string line =
        strCat(work, " ended by an exception, \"", quotable(thrown.what()),
               "\"; the server goes on. This is a fault of the server; please report it");
    const std::optional<std::string> due = rare.take(line, wallTimeNs());
    if (due) log(LogLevel::kError, *due);
  } catch (const std::exception&) {
    // No memory to say it.
  }
}

absl::Status refusalFor(const std::exception& thrown) noexcept {
  const bool lacks_memory = isLackOfMemory(thrown);
  try {
    if (lacks_memory) return outOfMemory();
    noteThrown("a request", thrown);
    return absl::InternalError(
        "the server failed while it answered this request; other requests are answered. Its log "
        "says why: tell its operator");
  } catch (const std::exception&) {
    // A status without a message takes no memory.
    return {lacks_memory ? absl::StatusCode::kResourceExhausted : absl::StatusCode::kInternal, {}};
  }
}

}  // namespace viewloom
