// SPDX-License-Identifier: Apache-2.0
#include "walk/walked_frame.h"

#include <utility>

#include "gpu/device_error.h"

namespace viewloom {
namespace {

// Calls it, and says in words for users that the device has no memory left for that.
template <typename Call>
auto withinMemory(const Call& call) {
  try {
    return call();
  } catch (const std::exception& error) {
    if (!isOutOfDeviceMemory(error)) throw;
    throw EngineOutOfMemory(deviceErrorText(error));
  }
}

}  // namespace

void WalkedFrame::take(FramePtr frame) {
  shapes_ = shapesOf(*frame);
  frame_ = std::move(frame);
}

void WalkedFrame::reserve() {
  withinMemory([this] {
    std::lock_guard lock(builds_->mutex);
    makeRoom();
  });
}

int64_t WalkedFrame::prepare(const Clock& clock) {
  if (!frame_) return 0;
  return withinMemory([&] {
    std::lock_guard lock(builds_->mutex);
    makeRoom();
    return build(clock);
  });
}

// Under the lock of the builds.
void WalkedFrame::makeRoom() {
  if (!fits(builds_->memory, shapes_)) {
    builds_->memory.clear();
    builds_->memory = makeBuildMemory(works_.device, shapes_);
  }
  if (form_ && form_->shapes == shapes_) {
    form_->structure.buildIn(builds_->memory);
  } else {
    form_.reset();
    form_.emplace(works_.device, builds_->memory, shapes_);
  }
}

// The same. Returns how long it took to copy the planes.
int64_t WalkedFrame::build(const Clock& clock) {
  const int64_t begun_ns = clock.nowNs();
  form_->structure.upload(*frame_);
  const int64_t uploaded_ns = clock.nowNs();
  form_->structure.recordBuild(form_->recorder.begin(), works_.builder);
  works_.timeline.wait(form_->recorder.submit(works_.timeline));
  frame_ = nullptr;
  return uploaded_ns - begun_ns;
}

FrameMeasures WalkedFrame::measures() const {
  return {.stats = structure().stats().front(), .depths = structure().depthSpread()};
}

}  // namespace viewloom
