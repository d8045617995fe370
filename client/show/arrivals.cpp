// SPDX-License-Identifier: Apache-2.0
#include "show/arrivals.h"

#include <SDL.h>

#include <utility>

namespace viewloom::show {

void Arrivals::take(const Atlas& atlas) {
  std::unique_lock decoder_lock(decoder_mutex_);
  absl::StatusOr<DecodedAtlas> decoded = decodeAtlas(atlas, decoder_);
  decoder_lock.unlock();
  if (!decoded.ok()) return fail(decoded.status());
  const int64_t due_ns = dueTimeNs(atlas.header.present_at_ns(), wallTimeNs());
  queue_.offer(*std::move(decoded), due_ns);
  wakeMainThread();
}

void Arrivals::fail(const absl::Status& status) {
  {
    std::lock_guard lock(mutex_);
    failure_ = status;
  }
  wakeMainThread();
}

absl::Status Arrivals::failed() const {
  std::lock_guard lock(mutex_);
  return failure_;
}

void wakeMainThread() {
  SDL_Event event = {};
  event.type = SDL_USEREVENT;
  SDL_PushEvent(&event);
}

}  // namespace viewloom::show
