// SPDX-License-Identifier: Apache-2.0
#include "schedule/frame_door.h"

namespace viewloom {

FrameDoor::Answer FrameDoor::knock() {
  std::lock_guard lock(mutex_);
  switch (state_) {
    case State::kEmpty:
      state_ = State::kWaits;
      return Answer::kFirst;
    case State::kOpen:
      state_ = State::kIsIn;
      return Answer::kComeIn;
    case State::kWaits:
    case State::kIsIn:
      break;
  }
  return Answer::kWaitOn;
}

bool FrameDoor::enter() {
  std::lock_guard lock(mutex_);
  if (state_ == State::kOpen) state_ = State::kIsIn;
  if (state_ != State::kEmpty) return false;
  state_ = State::kWaits;
  return true;
}

FrameDoor::Opened FrameDoor::open() {
  std::lock_guard lock(mutex_);
  if (state_ == State::kEmpty) return Opened::kNobody;
  if (state_ != State::kWaits) return Opened::kBefore;
  state_ = State::kOpen;
  return Opened::kNow;
}

void FrameDoor::close() {
  std::lock_guard lock(mutex_);
  state_ = State::kEmpty;
}

bool FrameDoor::hasWaiting() const {
  std::lock_guard lock(mutex_);
  return state_ == State::kWaits;
}

bool FrameDoor::isOpen() const {
  std::lock_guard lock(mutex_);
  return state_ == State::kOpen || state_ == State::kIsIn;
}

}  // namespace viewloom
