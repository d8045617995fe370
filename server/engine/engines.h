// SPDX-License-Identifier: Apache-2.0
// The engines of this server, and frames in the forms that they take them in.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "base/worker_pool.h"
#include "engine/engine.h"

namespace viewloom {

// The preferred engine comes first: it makes what it can. Outlives those who use it.
struct Engines {
  std::vector<std::unique_ptr<Engine>> all;
  // Threads for work on whole frames; the pipeline and the engines share them.
  std::unique_ptr<WorkerPool> workers;

  // The first engine that takes such frames, or all.size().
  size_t firstFor(const Frame& frame) const;
  // Memory that the first engine that takes such frames prepares one in.
  uint64_t preparedBytes(const FrameFormat& format) const;
};

// The preparers of one stream, one an engine.
class StreamPreparers {
 public:
  explicit StreamPreparers(const Engines& engines);
  FramePreparer& of(size_t engine) { return *preparers_[engine]; }
  size_t count() const { return preparers_.size(); }

 private:
  std::vector<std::unique_ptr<FramePreparer>> preparers_;
};

// One frame in the forms of all engines that take it. The form of the first of those is prepared
// before the frame is resident; the others are when a picture needs them. Thread-safety:
// isPrepared() from any thread; a form is prepared by one thread at a time, and read once it is
// prepared.
class FrameForms {
 public:
  explicit FrameForms(StreamPreparers& preparers);

  // The frame that they are for from now on; makes room for its first form. Throws
  // EngineOutOfMemory.
  void take(const FramePtr& frame, const Engines& engines);

  // nullptr where the engine does not take the frame.
  PreparedFrame* of(size_t engine) const { return takes_[engine] ? forms_[engine].get() : nullptr; }
  // The one that is prepared first; some engine takes the frame.
  PreparedFrame& first() const { return *forms_[first_]; }

  bool isPrepared(size_t engine) const { return *is_prepared_[engine]; }
  // Prepares the form of an engine, unless it is. As PreparedFrame::prepare().
  int64_t prepare(size_t engine, const Clock& clock, const PreparationEvents& events) const;
  int64_t prepareFirst(const Clock& clock, const PreparationEvents& events) const {
    return prepare(first_, clock, events);
  }

 private:
  std::vector<std::unique_ptr<PreparedFrame>> forms_;
  std::vector<bool> takes_;
  std::vector<std::unique_ptr<std::atomic<bool>>> is_prepared_;
  size_t first_ = 0;
};

}  // namespace viewloom
