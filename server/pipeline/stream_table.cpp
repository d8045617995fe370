// SPDX-License-Identifier: Apache-2.0
#include "pipeline/stream_table.h"

#include <utility>

namespace viewloom {

StreamInstant PipelineStream::newest() const {
  std::lock_guard lock(mutex_);
  return newest_;
}

// The replaced frame goes with the argument, after the lock.
void PipelineStream::setNewest(StreamInstant newest) {
  std::lock_guard lock(mutex_);
  std::swap(newest_, newest);
}

void PipelineStream::setMotion(const CameraMotion& motion) {
  std::lock_guard lock(mutex_);
  newest_.motion = motion;
}

void PipelineStream::notePublisher(const Payer& publisher) {
  std::lock_guard lock(mutex_);
  publisher_ = publisher;
}

Claim PipelineStream::claim() const {
  std::lock_guard lock(mutex_);
  return {.payers = {publisher_}, .stream = name};
}

StreamTable::StreamTable(const Engines& engines, MemoryBudget& memory, uint32_t slots_per_stream,
                         std::function<void()> on_slot_return)
    : engines_(engines),
      memory_(memory),
      slots_per_stream_(slots_per_stream),
      on_slot_return_(std::move(on_slot_return)) {}

PipelineStreamPtr StreamTable::open(const std::string& name) {
  std::lock_guard lock(mutex_);
  PipelineStreamPtr& stream = streams_[name];
  if (!stream) {
    stream = std::make_shared<PipelineStream>(name, engines_, slots_per_stream_, on_slot_return_);
    memory_.addIdle(stream->slots.idleMemory());
  }
  return stream;
}

PipelineStreamPtr StreamTable::find(const std::string& name) const {
  std::lock_guard lock(mutex_);
  const auto found = streams_.find(name);
  return found == streams_.end() ? nullptr : found->second;
}

void StreamTable::forget(const std::string& name) {
  PipelineStreamPtr forgotten;  // freed after the lock
  std::lock_guard lock(mutex_);
  if (const auto found = streams_.find(name); found != streams_.end()) {
    forgotten = std::move(found->second);
    streams_.erase(found);
  }
}

std::vector<PipelineStreamPtr> StreamTable::all() const {
  std::lock_guard lock(mutex_);
  std::vector<PipelineStreamPtr> streams;
  for (const auto& [name, stream] : streams_) streams.push_back(stream);
  return streams;
}

void StreamTable::clear() {
  std::map<std::string, PipelineStreamPtr> forgotten;  // freed after the lock
  std::lock_guard lock(mutex_);
  forgotten.swap(streams_);
}

}  // namespace viewloom
