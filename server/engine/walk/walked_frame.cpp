// SPDX-License-Identifier: Apache-2.0
#include "walk/walked_frame.h"

#include <utility>

#include "walk/within_device_memory.h"

namespace viewloom {
namespace {

// Memory of this machine, bytes. That of a graphics card is its own, and limits itself.
uint64_t buildBytesOf(const Device& device, const std::vector<FrameShape>& shapes) {
  uint64_t bytes = 0;
  for (const FrameShape& shape : shapes) {
    bytes += device.info().shares_memory ? buildBytes(shape) : shape.staged_bytes;
  }
  return bytes;
}

uint64_t structureBytesOf(const Device& device, const std::vector<FrameShape>& shapes) {
  uint64_t bytes = 0;
  if (!device.info().shares_memory) return bytes;
  for (const FrameShape& shape : shapes) bytes += structureBytes(shape);
  return bytes;
}

}  // namespace

void WalkedFrame::take(FramePtr frame) {
  shapes_ = shapesOf(*frame);
  frame_ = std::move(frame);
}

void WalkedFrame::reserve() {
  withinDeviceMemory([this] {
    std::lock_guard lock(builds_->mutex);
    makeRoom();
  });
}

int64_t WalkedFrame::prepare(const Clock& clock, const PreparationEvents& events) {
  if (!frame_) return 0;
  const LastingUse use(works_.use);
  return withinDeviceMemory([&] {
    std::lock_guard lock(builds_->mutex);
    makeRoom();
    return build(clock, events);
  });
}

// Under the lock of the builds, while the frame is there.
void WalkedFrame::makeRoom() {
  const bool has_form = form_ && form_->shapes == shapes_;
  if (!has_form) form_.reset();
  if (!fits(builds_->memory, shapes_)) {
    builds_->memory.clear();
    builds_->reserved = nullptr;
    builds_->reserved =
        std::make_shared<const Reservation>(reserveBytes(buildBytesOf(works_.device, shapes_)));
    builds_->memory = makeBuildMemory(works_.device, shapes_);
  }
  if (has_form) {
    form_->structure.buildIn(builds_->memory);
  } else {
    form_.emplace(works_.device, builds_->memory, shapes_,
                  reserveBytes(structureBytesOf(works_.device, shapes_)));
  }
  form_->build_reserved = builds_->reserved;
}

Reservation WalkedFrame::reserveBytes(uint64_t bytes) const {
  absl::StatusOr<Reservation> reserved = works_.memory.reserve(
      {.use = MemoryUse::kStructures, .identity = frame_->publisher, .bytes = bytes},
      "preparing the frame", [](uint64_t) { return "Publish smaller frames or fewer layers"; });
  if (!reserved.ok()) throw EngineOutOfMemory(std::string(reserved.status().message()));
  return *std::move(reserved);
}

uint64_t WalkedFrame::bytesFor(const Device& device, const FrameFormat& format) {
  const std::vector<FrameShape> shapes = shapesOf(format);
  return buildBytesOf(device, shapes) + structureBytesOf(device, shapes);
}

// The same. Returns how long it took to copy the planes.
int64_t WalkedFrame::build(const Clock& clock, const PreparationEvents& events) {
  const int64_t begun_ns = clock.nowNs();
  form_->structure.upload(*frame_);
  const int64_t uploaded_ns = clock.nowNs();
  buildInPieces(events);
  frame_ = nullptr;
  return uploaded_ns - begun_ns;
}

// One submission at a time, so that others get their turn on the device in between.
void WalkedFrame::buildInPieces(const PreparationEvents& events) {
  CommandRecorder& recorder = form_->recorder;
  uint64_t kernel_count = works_.device.kernelCount();
  const auto submit = [&](const BuiltPx& recorded) {
    const int64_t predicted_ns = works_.build_costs.predictNs(recorded);
    const int64_t submitted_ns = wallTimeNs();
    works_.timeline.wait(recorder.submit(works_.timeline));
    const int64_t measured_ns = works_.clock.noteDone(submitted_ns);
    // A kernel that the device compiles on the way says nothing about px.
    const uint64_t kernels_before = std::exchange(kernel_count, works_.device.kernelCount());
    if (kernels_before == kernel_count) works_.build_costs.note(recorded, measured_ns);
    events.on_piece({.predicted_ns = predicted_ns, .measured_ns = measured_ns});
  };
  CutRecording cuts(recorder.begin(), works_.build_costs, kPiece_ns, [&](const BuiltPx& recorded) {
    submit(recorded);
    if (events.is_given_up()) throw PreparationGivenUp();
    return recorder.begin();
  });
  form_->structure.recordBuild(cuts, works_.builder);
  submit(cuts.recorded());
}

FrameMeasures WalkedFrame::measures() const {
  return {.stats = structure().stats().front(), .depths = structure().depthSpread()};
}

}  // namespace viewloom
