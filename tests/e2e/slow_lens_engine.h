// SPDX-License-Identifier: Apache-2.0
// An engine for which every part of a lens takes 30 ms of its device, however fast that is, and
// which can be held between two of them.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "engine/engine.h"

namespace viewloom::test {

// Holds the thread that makes a lens once, when one part is paid for, until it is released.
// Thread-safety: all methods may be called from any thread.
class LensHold {
 public:
  void notePaid() {
    std::lock_guard lock(mutex_);
    is_paid_ = true;
  }
  // Whether it has held.
  bool beforePart() {
    std::unique_lock lock(mutex_);
    if (!is_paid_ || is_released_) return false;
    is_reached_ = true;
    changed_.notify_all();
    changed_.wait(lock, [this] { return is_released_; });
    return true;
  }
  void waitUntilReached() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_reached_; });
  }
  void release() {
    std::lock_guard lock(mutex_);
    is_released_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_paid_ = false;
  bool is_reached_ = false;
  bool is_released_ = false;
};

inline constexpr int64_t kLensPart_ns = 30'000'000;

class SlowLens final : public Making {
 public:
  SlowLens(std::unique_ptr<Making> lens, LensHold& hold) : lens_(std::move(lens)), hold_(hold) {}

  const TraceOutputs& planes() const override { return lens_->planes(); }
  bool holdsRoom() const override { return lens_->holdsRoom(); }
  MakingStep step() override {
    // Asked again, as if there had been no room: with all that has come meanwhile.
    if (hold_.beforePart()) return {.has_room = false};
    MakingStep step = lens_->step();
    if (step.predicted_ns == 0) return step;
    step.predicted_ns = kLensPart_ns;
    hold_.notePaid();
    return step;
  }
  void giveUp() override { lens_->giveUp(); }

 private:
  const std::unique_ptr<Making> lens_;
  LensHold& hold_;
};

// Thread-safety: as of the engine that it wraps.
class SlowLensEngine final : public Engine {
 public:
  // The hold outlives it.
  SlowLensEngine(std::unique_ptr<Engine> engine, LensHold& hold)
      : engine_(std::move(engine)), hold_(hold) {}

  TraceMethod method() const override { return engine_->method(); }
  void connect(EngineEvents events) override { engine_->connect(std::move(events)); }
  bool takes(const Frame& frame) const override { return engine_->takes(frame); }
  uint64_t preparedBytes(const FrameFormat& format) const override {
    return engine_->preparedBytes(format);
  }
  std::unique_ptr<FramePreparer> preparer() override { return engine_->preparer(); }
  bool isReadyFor(const Frame& frame, std::function<void()> then) override {
    return engine_->isReadyFor(frame, std::move(then));
  }
  PlanPtr plan(const PicturePtr& picture, const PreparedFrame& frame) const override {
    return engine_->plan(picture, frame);
  }
  bool isReady(const AtlasOrder& order, std::function<void()> then) override {
    return engine_->isReady(order, std::move(then));
  }
  bool hasRoomForEyes(const std::string& payer) override { return engine_->hasRoomForEyes(payer); }
  std::unique_ptr<Making> begin(AtlasOrder order, HandOn hand_on) override {
    if (!order.picture->hasLens()) return engine_->begin(std::move(order), std::move(hand_on));
    order.note_work = [note = std::move(order.note_work)](const DoneWork&) {
      note({.predicted_ns = kLensPart_ns, .measured_ns = kLensPart_ns});
    };
    std::unique_ptr<Making> lens = engine_->begin(std::move(order), std::move(hand_on));
    return lens ? std::make_unique<SlowLens>(std::move(lens), hold_) : nullptr;
  }
  std::optional<std::chrono::nanoseconds> workAhead() override { return engine_->workAhead(); }
  void drain() override { engine_->drain(); }

 private:
  const std::unique_ptr<Engine> engine_;
  LensHold& hold_;
};

}  // namespace viewloom::test
