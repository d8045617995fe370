// SPDX-License-Identifier: Apache-2.0
#include "trace/trace_slot.h"

#include <algorithm>
#include <cstring>

#include "base/check.h"
#include "gpu/commands.h"

namespace viewloom {
namespace {

ReadablePlane planeOf(const Device& device, uint64_t size_bytes, const char* name) {
  return size_bytes > 0 ? ReadablePlane(device, size_bytes, name) : ReadablePlane();
}

Buffer bufferOf(const Device& device, uint64_t size_bytes, const char* name) {
  return size_bytes > 0 ? Buffer(device, {.size_bytes = size_bytes, .debug_name = name}) : Buffer();
}

constexpr uint32_t kOpaqueBlack = 0xff000000;

bool hasUnusedPixels(const TraceJob& job) {
  const AtlasLayout& layout = *job.layout;
  return job.hasEyesBeside() || layout.padding_right_px > 0 || layout.padding_top_px > 0 ||
         layout.views.size() < size_t{layout.columns} * layout.rows;
}

// Pixels outside all views are black. Every plane is cleared, so that no byte of an older band is
// left.
void recordClear(Commands commands, const ReadablePlane& plane, uint32_t value) {
  if (!plane.isEmpty()) commands.fill(plane.target(), value);
}

template <typename T>
std::span<const T> readAs(const ReadablePlane& plane, uint64_t count) {
  return {reinterpret_cast<const T*>(plane.bytes().data()), plane.isEmpty() ? 0 : count};
}

template <typename T>
std::span<T> changeAs(ReadablePlane& plane, uint64_t count) {
  return {reinterpret_cast<T*>(plane.mutableBytes().data()), plane.isEmpty() ? 0 : count};
}

}  // namespace

TraceSlot::TraceSlot(const Device& device, const TraceSlotShape& shape)
    : shape_(shape), params_(device, shape) {
  const TraceSlotSizes sizes = traceSlotSizes(shape, device.info().is_software);
  color_ = planeOf(device, sizes.color, "band color");
  unpacked_ = bufferOf(device, sizes.unpacked, "band rgba");
  depth_ = planeOf(device, sizes.depth, "band depth");
  mask_ = planeOf(device, sizes.mask, "band mask");
  linear_ = planeOf(device, sizes.linear, "band linear");
  records_ = planeOf(device, sizes.records, "band records");
  counters_ = planeOf(device, sizes.counters, "band counters");
  answers_ = bufferOf(device, sizes.answers, "answers of sources");
  sample_ = bufferOf(device, sizes.sample, "sample");
  sums_ = bufferOf(device, sizes.sums, "sums");
  met_ = bufferOf(device, sizes.met, "met surfaces");
  met_lists_ = bufferOf(device, sizes.met_lists, "lists of met");
  incomplete_ = bufferOf(device, sizes.incomplete, "incomplete");
  unfinished_ = bufferOf(device, sizes.unfinished, "unfinished");
  hits_ = bufferOf(device, sizes.hits, "hits");
  paths_ = bufferOf(device, sizes.paths, "reflected rays");
  reflected_ = bufferOf(device, sizes.reflected, "reflected light");
  if (sizes.reflection_settings > 0) {
    reflection_settings_ = Buffer(device, {.size_bytes = sizes.reflection_settings,
                                           .intent = MemoryIntent::kUpload,
                                           .debug_name = "reflection settings"});
  }
}

void TraceSlot::recordBegin(Commands commands, std::span<const StructureSlot* const> structures,
                            const TraceJob& job, BandRows rows) {
  const AtlasLayout& layout = *job.layout;
  TraceSlotShape needed = slotShape(job, rows.row_count, shape_.outputs);
  VIEWLOOM_CHECK(shape_.holds(needed));
  VIEWLOOM_CHECK(structures.size() == job.walk_count);
  band_px_ = {layout.size_px.width, rows.row_count};
  params_.write(structures, job, planes());
  params_.recordUpload(commands, job);
  recordClear(commands, counters_, 0);
  if (hasUnusedPixels(job)) {
    commands.fill(sampleTarget(job), kOpaqueBlack);
    // The second stage of a lens writes px of views alone.
    if (job.mayGather()) commands.fill(rgba(), kOpaqueBlack);
    for (const ReadablePlane* plane : {&depth_, &mask_, &linear_, &records_}) {
      recordClear(commands, *plane, 0);
    }
  }
  recordTransferToCompute(commands);
}

void TraceSlot::recordReadback(Commands commands) const {
  const uint64_t area_px = band_px_.area();
  recordComputeToTransfer(commands);
  color_.recordReadback(commands, colorBytes());
  depth_.recordReadback(commands, area_px * sizeof(float));
  mask_.recordReadback(commands, area_px);
  linear_.recordReadback(commands, area_px * 4 * sizeof(float));
  records_.recordReadback(commands, area_px * sizeof(abi::RayRecord));
  counters_.recordReadback(commands, kCounterCount * sizeof(uint32_t));
  recordTransferToHost(commands);
  recordComputeToHost(commands);
}

Descriptor TraceSlot::answersOf(uint32_t walk, const AnswersLayout& layout) const {
  const uint64_t size_bytes = layout.stride * sizeof(abi::RayAnswer);
  return {.binding = abi::kBindingBand,
          .kind = DescriptorKind::kStorage,
          .buffer = &answers_,
          .offset_bytes = walk * size_bytes,
          .size_bytes = size_bytes};
}

uint64_t TraceSlot::recordsAddress() const {
  return hits_.sizeBytes() > 0 ? hits_.address() : records_.address();
}

TracedPlanes TraceSlot::planes() const {
  return {.depth = depth_.address(),
          .mask = mask_.address(),
          .linear = linear_.address(),
          .records = recordsAddress(),
          .counters = counters_.address(),
          .met = shape_.met_count > 0 ? met_.address() : 0,
          .met_stride_bytes = band_px_.area() * sizeof(uint32_t)};
}

Descriptor TraceSlot::writeReflectionSettings(uint32_t walk,
                                              const abi::ReflectionSettings& settings) const {
  const uint64_t offset_bytes = walk * kDescriptorAlignment_bytes;
  std::memcpy(reflection_settings_.mapped().data() + offset_bytes, &settings, sizeof settings);
  return {.binding = abi::kBindingReflection,
          .kind = DescriptorKind::kUniform,
          .buffer = &reflection_settings_,
          .offset_bytes = offset_bytes,
          .size_bytes = sizeof settings};
}

uint64_t TraceSlot::hostBytesFor(const Device& device, const TraceSlotShape& shape) {
  const TraceSlotSizes sizes = traceSlotSizes(shape, device.info().is_software);
  const bool is_shared = device.info().shares_memory;
  return sizes.readableBytes() + (is_shared ? sizes.deviceBytes() : 0) +
         (is_shared ? 2 : 1) * TraceParams::uploadBytesFor(shape);
}

uint64_t TraceSlot::sizeBytes() const {
  uint64_t total_bytes = 0;
  for (const ReadablePlane* plane : {&color_, &depth_, &mask_, &linear_, &records_, &counters_}) {
    total_bytes += plane->bytes().size();
  }
  return total_bytes + unpacked_.sizeBytes() + params_.sizeBytes() + answers_.sizeBytes() +
         sample_.sizeBytes() + sums_.sizeBytes() + met_.sizeBytes() + met_lists_.sizeBytes() +
         incomplete_.sizeBytes() + unfinished_.sizeBytes() + hits_.sizeBytes() +
         reflected_.sizeBytes() + reflection_settings_.sizeBytes() + paths_.sizeBytes();
}

std::span<const uint32_t> TraceSlot::color() const {
  return readAs<uint32_t>(color_, rgbaCount());
}

std::span<uint32_t> TraceSlot::mutableColor() {
  return changeAs<uint32_t>(color_, rgbaCount());
}

std::span<float> TraceSlot::mutableLinear() {
  return changeAs<float>(linear_, linearCount());
}

std::span<const uint8_t> TraceSlot::ycbcr() const {
  return readAs<uint8_t>(color_, isRgba() ? 0 : colorBytes());
}

uint64_t TraceSlot::colorBytes() const {
  return colorBytesOf(band_px_, shape_.outputs.color);
}

std::span<const float> TraceSlot::depth() const {
  return readAs<float>(depth_, band_px_.area());
}

std::span<const uint8_t> TraceSlot::mask() const {
  return readAs<uint8_t>(mask_, band_px_.area());
}

std::span<const float> TraceSlot::linear() const {
  return readAs<float>(linear_, linearCount());
}

std::span<const abi::RayRecord> TraceSlot::records() const {
  return readAs<abi::RayRecord>(records_, band_px_.area());
}

uint32_t TraceSlot::counted(uint32_t place) const {
  const auto sets = readAs<uint32_t>(counters_, kCounterCount);
  uint32_t count = 0;
  for (size_t i = place; i < sets.size(); i += abi::kCounterStride) count += sets[i];
  return count;
}

Coverage TraceSlot::coverage() const {
  return {.hit = counted(abi::kClassHit),
          .hit_assumed = counted(abi::kClassHitAssumed),
          .hidden = counted(abi::kClassHidden),
          .outside = counted(abi::kClassOutside),
          .empty = counted(abi::kClassEmpty)};
}

ReflectionCounts TraceSlot::reflections() const {
  return {.hit = counted(abi::kReflectionHit),
          .assumed = counted(abi::kReflectionAssumed),
          .back = counted(abi::kReflectionBack),
          .cube = counted(abi::kReflectionCube),
          .environment = counted(abi::kReflectionEnvironment),
          .bent = counted(abi::kReflectionBent)};
}

}  // namespace viewloom
