// SPDX-License-Identifier: Apache-2.0
// What comes to the px of a band by way of surfaces that mirror, in one source and in several.
#include <algorithm>
#include <cstring>

#include "gpu/barrier.h"
#include "picture/ray_sources.h"
#include "trace/band_params.h"
#include "trace/reflection_settings.h"
#include "trace/view_tracer.h"

namespace viewloom {
namespace {

// A bit for each source that has this.
template <typename Has>
uint32_t sourceBits(const TraceJob& job, const Has& has) {
  uint32_t bits = 0;
  for (size_t i = 0; i < job.sources.size(); ++i) bits |= uint32_t{has(job.sources[i])} << i;
  return bits;
}

}  // namespace

ReflectedTarget ViewTracer::reflectedTarget(const TraceJob& job, BandRows rows,
                                            const TraceSlot& slot) {
  // The mean of several samples is made of their codes.
  const bool shows_linear = !slot.linear_.isEmpty() && job.sample_count == 1;
  return {.rows = rows,
          .reflected = slot.reflected_,
          .rgba = slot.sampleTarget(job),
          .linear_address = shows_linear ? slot.linear_.target().address() : 0};
}

std::vector<Descriptor> ViewTracer::describeReflected(const Walk& walk, uint32_t first_walk) {
  const Descriptor settings = walk.slot.reflectionDescriptor(walk.index);
  const abi::ReflectionSettings values =
      reflectionSettings(walk.structure, walk.job, walk.index, first_walk);
  std::memcpy(walk.slot.reflection_settings_.mapped().data() + settings.offset_bytes, &values,
              sizeof values);
  std::vector<Descriptor> params =
      describeParams(walk.job, walk.index, walk.rays.sample, walk.slot);
  params.push_back(settings);
  return params;
}

// Of rows of a band whose px are known. The last of them adds all to the px.
void ViewTracer::recordReflections(Commands commands,
                                   std::span<const StructureSlot* const> structures,
                                   const TraceJob& job, BandRows rows, const BandPart& part,
                                   TraceSlot& slot) {
  if (job.walk_count == 1) {
    recordMirrors(commands, {*structures[0], job, 0, {.sample = part.first_sample}, slot, {}}, rows,
                  part);
  } else {
    recordPaths(commands, structures, job, rows, part, slot);
  }
  if (part.end_row < rows.row_count) return;
  reflector_.recordAdd(commands, job, reflectedTarget(job, rows, slot));
}

void ViewTracer::recordMirrors(Commands commands, const Walk& walk, BandRows rows,
                               const BandPart& part) {
  std::vector<Descriptor> params = describeReflected(walk, walk.index);
  params.push_back(walk.slot.lensDescriptor(walk.job, walk.rays.sample));
  const BandRows piece{rows.first_row + part.first_row, part.end_row - part.first_row};
  abi::TracePush push = describeBand(walk, walk.structure.color(), piece);
  push.band_row = part.first_row;
  reflector_.record(commands, {.structure = walk.structure,
                               .job = walk.job,
                               .row_count = piece.row_count,
                               .push = push,
                               .params = params,
                               .reflected = walk.slot.reflected_});
}

// All rays of one sample that have met as many mirrors: turned where they are, then followed
// through every source.
void ViewTracer::recordBounce(Commands commands, std::span<PathPiece> pieces, const TraceJob& job,
                              const AnswersLayout& answers, const MergedPaths& merged,
                              const TraceSlot& slot) {
  bool is_first = true;
  for (PathPiece& piece : pieces) {
    piece.push.bounce = merged.push.bounce;
    piece.push.sample_index = merged.push.sample_index;
    if (!piece.mirrors()) continue;
    abi::TracePush& push = piece.push;
    push.fill = is_first ? push.fill | abi::kFillFirst : push.fill & ~abi::kFillFirst;
    path_reflector_.recordTurns(commands, piece);
    recordComputeBarrier(commands);
    is_first = false;
  }
  for (const PathPiece& piece : pieces) path_reflector_.recordWalk(commands, piece);
  recordComputeBarrier(commands);
  const uint64_t all = (uint64_t{1} << job.walk_count) - 1;
  recordJoins(commands, job, all, job.layout->size_px.width * merged.rows.row_count, answers, slot);
  path_reflector_.recordMerge(commands, merged);
  recordComputeBarrier(commands);
}

// Piece by piece of the rows, as the views' own rays are traced.
void ViewTracer::recordPaths(Commands commands, std::span<const StructureSlot* const> structures,
                             const TraceJob& job, BandRows rows, const BandPart& part,
                             const TraceSlot& slot) {
  const Rays rays{.sample = part.first_sample};
  const uint32_t width_px = job.layout->size_px.width;
  const ReflectionSpec& spec = *job.reflection;
  const AnswersLayout answers = reflectedAnswersLayout(width_px, rows.row_count, job.walk_count);
  const auto mirrors = [&](const JobSource& source) {
    return structures[source.first_walk]->surface() != nullptr;
  };
  abi::MergePathsPush push{
      .counters = addressWords(slot.counters_.target().address()),
      .atlas_width_px = width_px,
      .band_row = 0,
      .source_count = uint32_t(job.sources.size()),
      .answers_stride = answers.stride,
      .first_walks = packFirstWalks(job),
      .cube_maps = sourceBits(job, [](const JobSource& source) { return source.isCubeMap(); }),
      .mirrors = sourceBits(job, mirrors),
      .bounce = 0,
      .bounce_count = spec.bounce_count,
      .sample_index = 0,
      .sample_count = spec.sample_count,
      .environment = environmentOf(spec)};
  for (uint32_t row = part.first_row; row < part.end_row; row += answers.row_count) {
    const BandRows piece{rows.first_row + row, std::min(answers.row_count, part.end_row - row)};
    push.band_row = row;
    std::vector<PathPiece> pieces = describePaths(structures, job, piece, rays, answers, slot);
    for (PathPiece& each : pieces) each.push.band_row = row;
    for (push.sample_index = 0; push.sample_index < push.sample_count; ++push.sample_index) {
      for (push.bounce = 0; push.bounce < push.bounce_count; ++push.bounce) {
        recordBounce(commands, pieces, job, answers,
                     {.push = push,
                      .rows = piece,
                      .answers = wholeBuffer(abi::kBindingAnswers, slot.answers_),
                      .paths = wholeBuffer(abi::kBindingPaths, slot.paths_),
                      .reflected = wholeBuffer(abi::kBindingReflected, slot.reflected_)},
                     slot);
      }
    }
  }
}

std::vector<PathPiece> ViewTracer::describePaths(std::span<const StructureSlot* const> structures,
                                                 const TraceJob& job, BandRows piece,
                                                 const Rays& rays, const AnswersLayout& answers,
                                                 const TraceSlot& slot) {
  const uint64_t size_bytes = answers.stride * sizeof(abi::RayAnswer);
  std::vector<PathPiece> pieces;
  for (uint32_t index = 0; index < job.walk_count; ++index) {
    const StructureSlot& structure = *structures[index];
    const Walk walk{structure, job, index, rays, slot, {}};
    pieces.push_back({.structure = structure,
                      .rays = raySourceOf(*job.layout),
                      .rows = piece,
                      .push = describeBand(walk, structure.color(), piece),
                      .params = describeReflected(walk, 0),
                      .through_lens = job.hasLens(),
                      .lens_points = slot.lensDescriptor(job, rays.sample),
                      .paths = wholeBuffer(abi::kBindingPaths, slot.paths_),
                      .answers = {.binding = abi::kBindingBand,
                                  .kind = DescriptorKind::kStorage,
                                  .buffer = &slot.answers_,
                                  .offset_bytes = index * size_bytes,
                                  .size_bytes = size_bytes}});
  }
  return pieces;
}

}  // namespace viewloom
