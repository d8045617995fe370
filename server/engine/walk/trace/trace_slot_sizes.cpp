// SPDX-License-Identifier: Apache-2.0
#include "trace/trace_slot_sizes.h"

#include <algorithm>

#include "shared/lens_abi.h"
#include "shared/reflection_abi.h"
#include "trace/px_runs.h"
#include "trace/trace_params.h"

namespace viewloom {
namespace {

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

TraceSlotSizes traceSlotSizes(const TraceSlotShape& shape, bool is_software) {
  const uint64_t area_px = uint64_t{shape.width_px} * shape.row_count_max;
  const SizePx largest_px = {shape.width_px, shape.row_count_max};
  const TraceOutputs& outputs = shape.outputs;
  const bool is_rgba = outputs.color == ColorForm::kRgba;
  TraceSlotSizes sizes{.color = colorBytesOf(largest_px, outputs.color),
                       .depth = outputs.depth ? area_px * sizeof(float) : 0,
                       // Filled in words: rounded up to whole ones.
                       .mask = outputs.mask ? (area_px + 3) / 4 * 4 : 0,
                       .linear = outputs.linear ? area_px * 4 * sizeof(float) : 0,
                       .records = outputs.records ? area_px * sizeof(abi::RayRecord) : 0,
                       .counters = kCounterCount * sizeof(uint32_t),
                       .unpacked = is_rgba ? 0 : colorBytesOf(largest_px, ColorForm::kRgba)};
  if (shape.walk_count > 1) sizes.answers = answersBytes(shape);
  if (shape.sums_light) {
    sizes.sample = area_px * sizeof(uint32_t);
    sizes.sums = area_px * sizeof(abi::vec3);
  }
  if (shape.met_count > 0) {
    sizes.met = shape.met_count * area_px * sizeof(uint32_t);
    sizes.met_lists = shape.met_lists_bytes;
  }
  if (shape.incomplete_count > 0) {
    sizes.incomplete = sizeof(abi::IncompleteHead) + shape.incomplete_count * sizeof(uint32_t);
  }
  if (is_software) {
    sizes.unfinished = sizeof(abi::IncompleteHead) + runCountMax(shape) * sizeof(uint32_t);
  }
  if (!shape.reflects) return sizes;
  static_assert(sizeof(abi::ReflectionSettings) <= kDescriptorAlignment_bytes);
  if (!outputs.records) sizes.hits = area_px * sizeof(abi::RayRecord);
  sizes.reflection_settings = shape.walk_count * kDescriptorAlignment_bytes;
  if (shape.walk_count > 1) sizes.paths = pathsBytes(shape);
  sizes.reflected = area_px * sizeof(abi::ReflectedLight);
  return sizes;
}

uint64_t colorBytesOf(SizePx size_px, ColorForm form) {
  return form == ColorForm::kRgba ? size_px.area() * sizeof(uint32_t)
                                  : YcbcrLayout(size_px, form).sizeBytes();
}

}  // namespace viewloom
