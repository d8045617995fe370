// SPDX-License-Identifier: Apache-2.0
#include "trace/pack_pass.h"

#include "gpu/commands.h"
#include "shaders/pack_band.h"
#include "shared/kernel_constants.h"
#include "shared/trace_abi.h"
#include "trace/band_params.h"

namespace viewloom {
namespace {

constexpr uint32_t kPixelsPerInvocation = 8;  // of a row
static_assert(YcbcrLayout::kPadding_px % kPixelsPerInvocation == 0);

constexpr DescriptorSlot kPackSlots[] = {{abi::kBindingBand, DescriptorKind::kStorage},
                                         {abi::kBindingPlanes, DescriptorKind::kStorage}};

}  // namespace

ComputePass PackPass::makePass(const Device& device, const ColorForm& form) {
  const KernelConstant is_420{abi::kIdIs420, form == ColorForm::kYcbcr420};
  return {device,
          {.spirv = pack_band_spirv,
           .push_bytes = sizeof(abi::PackPush),
           .constants = {&is_420, 1},
           .descriptors = kPackSlots,
           .debug_name = "pack band"}};
}

void PackPass::record(Commands commands, const Buffer& rgba, const Buffer& planes, SizePx size_px,
                      ColorForm form) {
  const YcbcrLayout layout(size_px, form);
  const Descriptor bindings[] = {wholeBuffer(abi::kBindingBand, rgba),
                                 wholeBuffer(abi::kBindingPlanes, planes)};
  const ComputePass& pack = passes_.get(form);
  recordComputeBarrier(commands);
  pack.recordDescriptors(commands, bindings);
  const uint32_t invocations = layout.luma_stride / kPixelsPerInvocation;
  pack.record(commands,
              abi::PackPush{.width_px = size_px.width,
                            .row_count = size_px.height,
                            .luma_stride = layout.luma_stride},
              (invocations + abi::kPackGroupSize - 1) / abi::kPackGroupSize,
              layout.chroma_row_count);
}

}  // namespace viewloom
