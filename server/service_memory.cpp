// SPDX-License-Identifier: Apache-2.0
#include "service_memory.h"

#include <algorithm>
#include <stdexcept>

#include "admission/display_price.h"
#include "admission/machine_memory.h"
#include "base/log.h"
#include "base/str_cat.h"
#include "frame/limits.h"

namespace viewloom {
namespace {

constexpr uint64_t kMiB = uint64_t{1} << 20;
// Where the system does not say how much it has.
constexpr uint64_t kUnknownMachine_bytes = 4096 * kMiB;
// Kernels that are compiled on the first use of each kind of display: of a CPU renderer, machine
// code in this process; of a graphics card, what its driver keeps.
constexpr uint64_t kCpuKernels_bytes = 320 * kMiB;
constexpr uint64_t kGpuKernels_bytes = 64 * kMiB;
constexpr uint64_t kMessagesMost_bytes = 256 * kMiB;
constexpr int64_t kStreamKept_ns = 5'000'000'000;
constexpr uint64_t kIdleStreamsPart = 32;
// A server that has less room is of no use: one frame on its way while another is shown, and one
// display.
constexpr SizePx kSmallFrame_px{1280, 720};
constexpr SizePx kSmallAtlas_px{1024, 1024};
constexpr uint64_t kFramesAtOnce = 2;

PlaneFormat rawPlane(PlaneKind kind, PlaneEncoding encoding) {
  PlaneFormat plane{.kind = kind, .encoding = encoding, .size_px = kSmallFrame_px};
  plane.wire_bytes = uncompressedBytes(plane);
  return plane;
}

FrameFormat smallFrame() {
  SourceFormat source;
  source.layers = {{.color = rawPlane(PlaneKind::kColor, PlaneEncoding::kRgba8),
                    .depth = rawPlane(PlaneKind::kDepth, PlaneEncoding::kDepthF32)}};
  return {.number = 1, .sources = {source}};
}

DisplayPrice smallDisplay() {
  DisplaySpec spec;
  spec.kind = QuiltSpec{.columns = 4, .rows = 4, .size_px = kSmallAtlas_px};
  return displayPrice(completeDisplaySpec(spec).value(), {});
}

// Least bytes that one client needs.
uint64_t leastBytes(const PreparedBytes& prepared_bytes) {
  const FrameFormat frame = smallFrame();
  const DisplayPrice display = smallDisplay();
  return kFramesAtOnce * (framePrice(frame).receiving_bytes + prepared_bytes(frame)) +
         display.displayBytes() + display.viewerBytes() + display.making_bytes + kConnectionBytes;
}

void requireRoomForOne(const MemoryBudget& budget, const PreparedBytes& prepared_bytes) {
  const uint64_t needed_bytes = leastBytes(prepared_bytes);
  if (budget.mostForOne() >= needed_bytes) return;
  // One client gets three quarters at most; a twentieth for rounding and growth.
  const uint64_t smallest_bytes = (budget.reservedBytes() + needed_bytes * 4 / 3) * 21 / 20;
  throw std::runtime_error(strCat(
      "memory.budget is ", memoryText(budget.totalBytes()), ", of which the server itself takes ",
      memoryText(budget.reservedBytes()), "; one frame of ", kSmallFrame_px.width, "x",
      kSmallFrame_px.height, " px and one display need a budget of at least ",
      smallest_bytes / kMiB, " MiB. Give --memory.budget ", (smallest_bytes / kMiB + 1) * kMiB,
      ", or more memory to the machine or container"));
}

void note(const Metrics& metrics, const MemoryBudget& budget) {
  metrics.memory_budget_bytes.set(double(budget.totalBytes()));
  metrics.memory_idle_bytes.set(double(budget.idleBytes()));
  metrics.memory_resident_bytes.set(double(residentBytes()));
  for (size_t use = 0; use < size_t(MemoryUse::kCount); ++use) {
    metrics.memory_reserved_bytes[MemoryUse(use)].set(double(budget.reservedBytes(MemoryUse(use))));
  }
}

}  // namespace

uint64_t memoryBudgetBytes(const MemoryConfig& config) {
  if (config.budget > 0) return config.budget;
  const uint64_t machine_bytes = machineMemoryBytes();
  if (machine_bytes == 0) {
    log(LogLevel::kWarning, "the system does not say how much memory it has; memory.budget is ",
        memoryText(kUnknownMachine_bytes / 4 * 3));
  }
  return (machine_bytes > 0 ? machine_bytes : kUnknownMachine_bytes) / 4 * 3;
}

uint64_t messageBytesMax(uint64_t budget_bytes) {
  constexpr uint64_t kPart = 8;
  return std::min(kMessagesMost_bytes, budget_bytes / kPart);
}

uint64_t IdleStreams::releaseIdle(std::chrono::nanoseconds unused_for) {
  const bool is_short = unused_for.count() == 0;
  const uint64_t kept_bytes = budget_.totalBytes() / kIdleStreamsPart;
  const auto takesTooMuch = [&] {
    return budget_.reservedBytes(MemoryUse::kFrames) +
               budget_.reservedBytes(MemoryUse::kStructures) >
           kept_bytes;
  };
  while ((is_short || takesTooMuch()) && directory_.forgetOldest(is_short ? 0 : kStreamKept_ns)) {
  }
  return 0;
}

ServiceMemory::ServiceMemory(MemoryBudget& budget, StreamDirectory& directory,
                             const Metrics& metrics, const PreparedBytes& prepared_bytes,
                             bool compiles_on_cpu)
    : program_(budget.charge(
          MemoryUse::kProgram,
          residentBytes() + (compiles_on_cpu ? kCpuKernels_bytes : kGpuKernels_bytes))),
      messages_(budget.charge(MemoryUse::kMessages, messageBytesMax(budget.totalBytes()))),
      idle_streams_(std::make_shared<IdleStreams>(budget, directory)) {
  requireRoomForOne(budget, prepared_bytes);
  log(LogLevel::kInfo, "memory: ", memoryText(budget.totalBytes()), ", of which the server takes ",
      memoryText(budget.reservedBytes()));
  budget.addIdle(idle_streams_);
  unused_.emplace(budget, [&budget, &metrics] { note(metrics, budget); });
}

}  // namespace viewloom
