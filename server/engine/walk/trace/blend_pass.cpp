// SPDX-License-Identifier: Apache-2.0
#include "trace/blend_pass.h"

#include <algorithm>

#include "gpu/commands.h"
#include "shaders/blend_samples.h"
#include "structure/structure_slot.h"
#include "trace/band_params.h"

namespace viewloom {
namespace {

constexpr DescriptorSlot kBlendSlots[] = {{abi::kBindingSample, DescriptorKind::kStorage},
                                          {abi::kBindingSums, DescriptorKind::kStorage},
                                          {abi::kBindingBand, DescriptorKind::kStorage}};

// Groups a row of the dispatch: bands have more px than a row may have groups.
constexpr uint32_t kGroupsPerRow = 1024;

// Weight of one channel.
float weightOf(const std::vector<RaySample>& samples, uint32_t index, uint8_t channel) {
  if ((samples[index].channels & channel) == 0) return 0;
  const auto counts = [&](const RaySample& sample) { return (sample.channels & channel) != 0; };
  return 1.0F / float(std::count_if(samples.begin(), samples.end(), counts));
}

}  // namespace

ComputePass BlendPass::makePass(const Device& device, const std::monostate&) {
  return {device,
          {.spirv = blend_samples_spirv,
           .push_bytes = sizeof(abi::BlendPush),
           .takes_parts = true,
           .descriptors = kBlendSlots,
           .debug_name = "blend samples"}};
}

void BlendPass::record(Commands commands, const BlendTarget& target,
                       const std::vector<RaySample>& samples, uint32_t index) {
  const abi::BlendPush push{
      .px_count = target.px_count,
      .is_first = index == 0,
      .is_last = index + 1 == samples.size(),
      .weights = {weightOf(samples, index, kRedChannel), weightOf(samples, index, kGreenChannel),
                  weightOf(samples, index, kBlueChannel)},
      .linear = addressWords(target.linear_address)};
  const Descriptor bindings[] = {wholeBuffer(abi::kBindingSample, target.sample),
                                 wholeBuffer(abi::kBindingSums, target.sums),
                                 wholeBuffer(abi::kBindingBand, target.band)};
  const uint32_t groups = groupCount(target.px_count);
  const auto rowAt = [&](uint32_t px) {
    return px == target.px_count ? (groups + kGroupsPerRow - 1) / kGroupsPerRow
                                 : px / abi::kTraceGroupSize / kGroupsPerRow;
  };
  const GroupRows rows{rowAt(target.first_px), rowAt(target.end_px)};
  recordComputeBarrier(commands);
  if (rows.first == rows.end) return;
  const ComputePass& blend = pass_.get({});
  blend.recordDescriptors(commands, bindings);
  blend.recordRows(commands, push, std::min(groups, kGroupsPerRow), rows);
  recordComputeBarrier(commands);
}

}  // namespace viewloom
