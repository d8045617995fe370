// SPDX-License-Identifier: Apache-2.0
#include "trace/color_averager.h"

#include "gpu/barrier.h"
#include "shaders/average_color.h"
#include "shared/kernel_constants.h"
#include "shared/trace_abi.h"
#include "trace/band_params.h"

namespace viewloom {
namespace {

constexpr DescriptorSlot kSlots[] = {{abi::kBindingStructure, DescriptorKind::kTexels},
                                     {abi::kBindingStructureHalves, DescriptorKind::kTexels},
                                     {abi::kBindingColor, DescriptorKind::kTexels},
                                     {abi::kBindingMeans, DescriptorKind::kStorage}};

// Px of a strip share what they load, and what an invocation costs before it does anything; on
// hardware neighbouring invocations would then load what lies apart.
constexpr uint32_t kStripOnSoftware_px = 32;

}  // namespace

ColorAverager::Color ColorAverager::record(Commands commands, const StructureSlot& structure,
                                           const ColorReach& reach) {
  const uint32_t format = colorFormat(structure.shape().color_storage);
  if (reach.isNone() || !structure.shape().canAverageColor()) return {structure.color(), format};
  std::lock_guard lock(mutex_);
  MeanColor& mean_color = structure.meanColor();
  MeanColor::Planes& planes = mean_color.planesFor(reach);
  if (planes.is_made) return {planes.means, abi::kColorCodes11};
  planes.is_made = true;
  const LayeredBuffer& along_y = structure.meansAlongY();
  // Others may have been made by way of the same memory before.
  recordComputeBarrier(commands);
  recordAlong(commands, structure, {true, reach.y_px, structure.color(), format, along_y});
  recordComputeBarrier(commands);
  recordAlong(commands, structure, {false, reach.x_px, along_y, abi::kColorCodes11, planes.means});
  recordComputeBarrier(commands);
  return {planes.means, abi::kColorCodes11};
}

void ColorAverager::recordAlong(Commands commands, const StructureSlot& structure,
                                const Axis& axis) {
  const uint32_t tap_count = tapCount(axis.reach_px);
  const uint32_t strip_px = device_->info().is_software ? kStripOnSoftware_px : 1;
  const ComputePass& average = pass({.reads_by_address = structure.readsByAddress(),
                                     .writes_by_address = !axis.to.fitsStorage(*device_),
                                     .format = axis.format,
                                     .is_along_y = axis.is_y,
                                     .tap_count = tap_count,
                                     .strip_px = strip_px});
  const SizePx size_px = structure.shape().depth_px;
  const uint32_t layer_count = structure.shape().layerCount();
  abi::AveragePush push{.layers = {},
                        .from = {},
                        .to = {},
                        .size_px = packSize(size_px),
                        .last_weight = tapWeight(axis.reach_px, tap_count)};
  for (uint32_t i = 0; i < layer_count; ++i) {
    push.layers[i] = addressWords(structure.structure().address(i));
    push.from[i] = addressWords(axis.from.address(i));
    push.to[i] = addressWords(axis.to.address(i));
  }
  const Descriptor descriptors[] = {
      structure.structure().asTexels(abi::kBindingStructure),
      structure.structure().asHalfTexels(abi::kBindingStructureHalves),
      axis.from.asTexels(abi::kBindingColor), axis.to.asStorage(abi::kBindingMeans)};
  average.recordDescriptors(commands, descriptors);
  const auto stripCount = [&](uint32_t length_px) { return (length_px + strip_px - 1) / strip_px; };
  const SizePx strips = axis.is_y ? SizePx{size_px.width, stripCount(size_px.height)}
                                  : SizePx{stripCount(size_px.width), size_px.height};
  // A software device gives each core a run of groups: layers come first, as deeper ones cost less.
  average.record(commands, push, layer_count, groupCount(strips.width), strips.height);
}

const ComputePass& ColorAverager::pass(const Variant& variant) {
  std::unique_ptr<ComputePass>& made = passes_[variant];
  if (!made) {
    const KernelConstant constants[] = {{abi::kIdReadsByAddress, variant.reads_by_address},
                                        {abi::kIdWritesByAddress, variant.writes_by_address},
                                        {abi::kIdColorFormat, variant.format},
                                        {abi::kIdIsAlongY, variant.is_along_y},
                                        {abi::kIdTapCount, variant.tap_count},
                                        {abi::kIdStripPx, variant.strip_px}};
    made = std::make_unique<ComputePass>(*device_,
                                         ComputePassOptions{.spirv = average_color_spirv,
                                                            .push_bytes = sizeof(abi::AveragePush),
                                                            .constants = constants,
                                                            .descriptors = kSlots,
                                                            .debug_name = "average color"});
  }
  return *made;
}

}  // namespace viewloom
