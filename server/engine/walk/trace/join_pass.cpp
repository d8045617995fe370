// SPDX-License-Identifier: Apache-2.0
#include "trace/join_pass.h"

#include <algorithm>

#include "frame/cube_map.h"
#include "gpu/commands.h"
#include "shaders/join_faces.h"
#include "shared/cube_abi.h"
#include "trace/band_params.h"

namespace viewloom {
namespace {

constexpr DescriptorSlot kJoinSlots[] = {{abi::kBindingAnswers, DescriptorKind::kStorage}};

}  // namespace

ComputePass JoinPass::makePass(const Device& device, const std::monostate&) {
  return {device,
          {.spirv = join_faces_spirv,
           .push_bytes = sizeof(abi::JoinPush),
           .takes_parts = true,
           .descriptors = kJoinSlots,
           .debug_name = "join faces"}};
}

void JoinPass::addMissing(const TraceJob& job, MissingKernels& missing) {
  const auto isCubeMap = [](const JobSource& source) { return source.isCubeMap(); };
  if (std::ranges::any_of(job.sources, isCubeMap)) pass_.addMissing({}, missing);
}

void JoinPass::record(Commands commands, const TraceJob& job, uint64_t walked, AnswerSpan span,
                      const AnswersLayout& answers, const TraceSlot& slot) {
  for (const JobSource& source : job.sources) {
    if (!source.isCubeMap()) continue;
    const ComputePass& join = pass_.get({});
    const abi::JoinPush push{
        .answer_count = span.end,
        .answers_stride = answers.stride,
        .first_walk = source.first_walk,
        .walked_faces = uint32_t(walked >> source.first_walk) & ((1U << kCubeFaceCount) - 1)};
    const Descriptor target = wholeBuffer(abi::kBindingAnswers, slot.answers());
    join.recordDescriptors(commands, std::span(&target, 1));
    join.recordColumns(commands, push, {span.first / abi::kTraceGroupSize, groupCount(span.end)},
                       1);
    recordComputeBarrier(commands);
  }
}

}  // namespace viewloom
