// SPDX-License-Identifier: Apache-2.0
#include "trace/trace_slot.h"

#include <algorithm>
#include <cstring>

#include "base/check.h"
#include "gpu/commands.h"
#include "shared/lens_abi.h"
#include "trace/px_runs.h"

namespace viewloom {
namespace {

ReadablePlane planeIf(bool wanted, const Device& device, uint64_t size_bytes, const char* name) {
  return wanted ? ReadablePlane(device, size_bytes, name) : ReadablePlane();
}

// So many answers fill whole descriptor alignments.
constexpr uint64_t kAnswersStep = kDescriptorAlignment_bytes / 4;
static_assert(kAnswersStep * sizeof(abi::RayAnswer) % kDescriptorAlignment_bytes == 0);

uint64_t answersRowBytes(uint32_t width_px, uint32_t walk_count) {
  return uint64_t{width_px} * walk_count * sizeof(abi::RayAnswer);
}

// Enough for every piece of every band that the slot holds.
uint64_t answersBytes(const TraceSlotShape& shape) {
  const uint64_t row_bytes = answersRowBytes(shape.width_px, shape.walk_count);
  return std::min(row_bytes * shape.row_count_max, std::max(row_bytes, kAnswersBytesMax)) +
         shape.walk_count * kAnswersStep * sizeof(abi::RayAnswer);
}

// A reflected ray takes as much memory as so many answers.
constexpr uint32_t kPathAnswers =
    (sizeof(abi::ReflectedPath) + sizeof(abi::RayAnswer) - 1) / sizeof(abi::RayAnswer);

// Enough for every piece of every band that the slot holds, of two walks or more.
uint64_t pathsBytes(const TraceSlotShape& shape) {
  const uint64_t width_px = shape.width_px;
  const uint64_t most = kAnswersBytesMax / ((2 + kPathAnswers) * sizeof(abi::RayAnswer));
  return std::min(width_px * shape.row_count_max, std::max(width_px, most)) *
         sizeof(abi::ReflectedPath);
}

// No more runs of px are in a band, each of which may be left unfinished.
uint64_t runCountMax(const TraceSlotShape& shape) {
  const uint64_t begun = std::min(shape.tile_count_max, shape.width_px);
  return shape.row_count_max * (shape.width_px / kRunPixelsMin + begun);
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

uint64_t colorBytesOf(SizePx size_px, ColorForm form) {
  return form == ColorForm::kRgba ? size_px.area() * sizeof(uint32_t)
                                  : YcbcrLayout(size_px, form).sizeBytes();
}

}  // namespace

AnswersLayout answersLayout(uint32_t width_px, uint32_t row_count, uint32_t walk_count) {
  const uint64_t row_bytes = answersRowBytes(width_px, walk_count);
  const uint64_t rows = std::clamp<uint64_t>(kAnswersBytesMax / row_bytes, 1, row_count);
  const uint64_t steps = (rows * width_px + kAnswersStep - 1) / kAnswersStep;
  return {.row_count = uint32_t(rows), .stride = uint32_t(steps * kAnswersStep)};
}

AnswersLayout reflectedAnswersLayout(uint32_t width_px, uint32_t row_count, uint32_t walk_count) {
  return answersLayout(width_px, row_count, walk_count + kPathAnswers);
}

TraceSlot::TraceSlot(const Device& device, const TraceSlotShape& shape)
    : shape_(shape), params_(device, shape) {
  const uint64_t area_px = uint64_t{shape.width_px} * shape.row_count_max;
  const SizePx largest_px = {shape.width_px, shape.row_count_max};
  color_ = ReadablePlane(device, colorBytesOf(largest_px, shape.outputs.color), "band color");
  if (shape.outputs.color != ColorForm::kRgba) {
    unpacked_ = Buffer(device, {.size_bytes = colorBytesOf(largest_px, ColorForm::kRgba),
                                .debug_name = "band rgba"});
  }
  depth_ = planeIf(shape.outputs.depth, device, area_px * sizeof(float), "band depth");
  // Filled in words: rounded up to whole ones.
  mask_ = planeIf(shape.outputs.mask, device, (area_px + 3) / 4 * 4, "band mask");
  linear_ = planeIf(shape.outputs.linear, device, area_px * 4 * sizeof(float), "band linear");
  records_ =
      planeIf(shape.outputs.records, device, area_px * sizeof(abi::RayRecord), "band records");
  counters_ = ReadablePlane(device, kCounterCount * sizeof(uint32_t), "band counters");
  if (shape.walk_count > 1) {
    answers_ =
        Buffer(device, {.size_bytes = answersBytes(shape), .debug_name = "answers of sources"});
  }
  if (shape.sums_light) {
    sample_ = Buffer(device, {.size_bytes = area_px * sizeof(uint32_t), .debug_name = "sample"});
    sums_ = Buffer(device, {.size_bytes = area_px * sizeof(abi::vec3), .debug_name = "sums"});
  }
  if (shape.met_count > 0) {
    met_ = Buffer(device, {.size_bytes = shape.met_count * area_px * sizeof(uint32_t),
                           .debug_name = "met surfaces"});
    met_lists_ =
        Buffer(device, {.size_bytes = shape.met_lists_bytes, .debug_name = "lists of met"});
  }
  if (shape.incomplete_count > 0) {
    incomplete_ = Buffer(device, {.size_bytes = sizeof(abi::IncompleteHead) +
                                                shape.incomplete_count * sizeof(uint32_t),
                                  .debug_name = "incomplete"});
  }
  if (device.info().is_software) {
    unfinished_ = Buffer(
        device, {.size_bytes = sizeof(abi::IncompleteHead) + runCountMax(shape) * sizeof(uint32_t),
                 .debug_name = "unfinished"});
  }
  if (shape.reflects) addReflections(device, area_px);
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

void TraceSlot::addReflections(const Device& device, uint64_t area_px) {
  if (!shape_.outputs.records) {
    hits_ = Buffer(device, {.size_bytes = area_px * sizeof(abi::RayRecord), .debug_name = "hits"});
  }
  static_assert(sizeof(abi::ReflectionSettings) <= kDescriptorAlignment_bytes);
  reflection_settings_ =
      Buffer(device, {.size_bytes = shape_.walk_count * kDescriptorAlignment_bytes,
                      .intent = MemoryIntent::kUpload,
                      .debug_name = "reflection settings"});
  if (shape_.walk_count > 1) {
    paths_ = Buffer(device, {.size_bytes = pathsBytes(shape_), .debug_name = "reflected rays"});
  }
  reflected_ = Buffer(device, {.size_bytes = area_px * sizeof(abi::ReflectedLight),
                               .debug_name = "reflected light"});
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
