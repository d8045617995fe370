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
// code in this process; of a graphics card, what its driver keeps. A small server reserves a part
// of its budget; what its kernels take beyond that is charged when it is seen (UnpricedMemory).
constexpr uint64_t kCpuKernels_bytes = 320 * kMiB;
constexpr uint64_t kGpuKernels_bytes = 64 * kMiB;
constexpr uint64_t kKernelsPart = 4;
constexpr uint64_t kMessagesMost_bytes = 256 * kMiB;
constexpr int64_t kStreamKept_ns = 5'000'000'000;
constexpr uint64_t kIdleStreamsPart = 32;
// A server that has less room is of no use: one frame on its way while another is shown, and one
// display.
constexpr SizePx kSmallFrame_px{1280, 720};
constexpr SizePx kSmallAtlas_px{1024, 1024};
constexpr uint64_t kFramesAtOnce = 2;
constexpr uint64_t kClients = 2;  // a publisher and a viewer

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
         display.displayBytes() + display.viewerBytes() + display.making_bytes + kConnectionBytes +
         kClients * (kConnectionBytes + kOpenCallBytes);
}

uint64_t kernelBytes(uint64_t budget_bytes, bool compiles_on_cpu) {
  return std::min(compiles_on_cpu ? kCpuKernels_bytes : kGpuKernels_bytes,
                  budget_bytes / kKernelsPart);
}

// The least budget with room for one client, whole MiB.
uint64_t smallestBudgetMiB(uint64_t program_bytes, uint64_t needed_bytes, bool compiles_on_cpu) {
  uint64_t budget_bytes = 0;
  // The server's own part grows with the budget by three eighths at most, so that this converges.
  for (int round = 0; round < 30; ++round) {
    const uint64_t own_bytes =
        program_bytes + kernelBytes(budget_bytes, compiles_on_cpu) + messageBytesMax(budget_bytes);
    // One client gets three quarters at most; a twentieth for rounding and growth.
    budget_bytes = (own_bytes + needed_bytes * 4 / 3) * 21 / 20;
  }
  return budget_bytes / kMiB + 1;
}

// `program_bytes`: of this process before its kernels.
void requireRoomForOne(const MemoryBudget& budget, uint64_t needed_bytes, uint64_t program_bytes,
                       bool compiles_on_cpu) {
  if (budget.mostForOne() >= needed_bytes) return;
  const uint64_t smallest_mib = smallestBudgetMiB(program_bytes, needed_bytes, compiles_on_cpu);
  throw std::runtime_error(strCat(
      "memory.budget is ", memoryText(budget.totalBytes()), ", of which the server itself takes ",
      memoryText(budget.reservedBytes()), "; one frame of ", kSmallFrame_px.width, "x",
      kSmallFrame_px.height, " px and one display need a budget of at least ", smallest_mib,
      " MiB. That is the default of a machine or container of ", smallest_mib * 4 / 3 + 1,
      " MiB. Give it more memory, or give --memory.budget ", smallest_mib * kMiB));
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
    : program_(budget.charge(MemoryUse::kProgram, residentBytes())),
      kernels_(
          budget.charge(MemoryUse::kProgram, kernelBytes(budget.totalBytes(), compiles_on_cpu))),
      messages_(budget.charge(MemoryUse::kMessages, messageBytesMax(budget.totalBytes()))),
      unpriced_(budget),
      idle_streams_(std::make_shared<IdleStreams>(budget, directory)) {
  requireRoomForOne(budget, leastBytes(prepared_bytes), program_.bytes(), compiles_on_cpu);
  log(LogLevel::kInfo, "memory: ", memoryText(budget.totalBytes()), ", of which the server takes ",
      memoryText(budget.reservedBytes()));
  budget.addIdle(idle_streams_);
  unused_.emplace(budget, [this, &budget, &metrics] {
    unpriced_.note(ownResidentBytes());
    note(metrics, budget);
    return unpriced_.bytes();
  });
}

}  // namespace viewloom
