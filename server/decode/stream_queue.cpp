// SPDX-License-Identifier: Apache-2.0
#include "decode/stream_queue.h"

#include <algorithm>
#include <vector>

namespace viewloom {

bool StreamQueue::drop(const std::string& stream) {
  return std::erase_if(queue_, [&](const Entry& entry) { return entry.origin.stream == stream; }) >
         0;
}

std::optional<FrameOrigin> StreamQueue::takeWanted(FrameSink& sink) {
  std::vector<FrameOrigin> left;
  for (const Entry& entry : queue_) {
    if (!entry.is_unwanted) left.push_back(entry.origin);
  }
  while (!left.empty()) {
    const auto next = left.begin() + std::ptrdiff_t(sink.nextToDecode(left));
    const auto entry = find(next->stream);
    if (sink.wantsFrame(next->stream)) {
      queue_.erase(entry);
      return std::move(*next);
    }
    entry->is_unwanted = true;
    left.erase(next);
  }
  return std::nullopt;
}

bool StreamQueue::allow(const std::string& stream) {
  const auto entry = find(stream);
  if (entry == queue_.end()) return false;
  entry->is_unwanted = false;
  return true;
}

std::optional<FrameOrigin> StreamQueue::takeNext(FrameSink& sink) {
  if (queue_.empty()) return std::nullopt;
  std::vector<FrameOrigin> all;
  for (const Entry& entry : queue_) all.push_back(entry.origin);
  const auto next = queue_.begin() + std::ptrdiff_t(sink.nextToDecode(all));
  FrameOrigin taken = std::move(next->origin);
  queue_.erase(next);
  return taken;
}

std::deque<StreamQueue::Entry>::iterator StreamQueue::find(const std::string& stream) {
  return std::ranges::find_if(queue_,
                              [&](const Entry& entry) { return entry.origin.stream == stream; });
}

}  // namespace viewloom
