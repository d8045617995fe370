// SPDX-License-Identifier: Apache-2.0
#include "trace/mean_color_pass.h"

#include <algorithm>

#include "gpu/commands.h"
#include "shaders/average_color.h"
#include "shared/kernel_constants.h"
#include "shared/trace_abi.h"
#include "structure/array_options.h"
#include "trace/band_params.h"

namespace viewloom {
namespace {

constexpr DescriptorSlot kMeanColorSlots[] = {
    {abi::kBindingStructure, DescriptorKind::kTexels},
    {abi::kBindingStructureHalves, DescriptorKind::kTexels},
    {abi::kBindingColor, DescriptorKind::kTexels},
    {abi::kBindingMeans, DescriptorKind::kStorage}};

// Px of a strip share what they load, and what an invocation costs before it does anything; on
// hardware neighbouring invocations would then load what lies apart.
constexpr uint32_t kStripOnSoftware_px = 32;
// Texels of a row of strips, which is the least that is made at once: some milliseconds.
constexpr uint64_t kStripTexelsMax = uint64_t{1} << 18;

bool isAveraged(const StructureSlot& structure, const ColorReach& reach) {
  return !reach.isNone() && structure.shape().canAverageColor();
}

}  // namespace

ComputePass MeanColorPass::makePass(const Device& device, const Variant& variant) {
  const KernelConstant constants[] = {{abi::kIdReadsByAddress, variant.reads_by_address},
                                      {abi::kIdWritesByAddress, variant.writes_by_address},
                                      {abi::kIdColorFormat, variant.format},
                                      {abi::kIdIsAlongY, variant.is_along_y},
                                      {abi::kIdTapCount, variant.tap_count},
                                      {abi::kIdStripPx, variant.strip_px}};
  return {device,
          {.spirv = average_color_spirv,
           .push_bytes = sizeof(abi::AveragePush),
           .constants = constants,
           .descriptors = kMeanColorSlots,
           .debug_name = "average color"}};
}

MeanColorPass::Variant MeanColorPass::variantOf(const StructureSlot& structure,
                                                const Axis& axis) const {
  const bool fits =
      LayeredBuffer::fitsStorage(device_, meanColorOptions(device_, structure.shape()));
  return {.reads_by_address = structure.readsByAddress(),
          .writes_by_address = !fits,
          .format = axis.format,
          .is_along_y = axis.is_y,
          .tap_count = tapCount(axis.reach_px),
          .strip_px = stripPx(structure)};
}

uint32_t MeanColorPass::stripPx(const StructureSlot& structure) const {
  if (!device_.info().is_software) return 1;
  const uint64_t row_texels =
      uint64_t{structure.shape().depth_px.width} * structure.shape().layerCount();
  uint32_t strip_px = kStripOnSoftware_px;
  while (strip_px > abi::kBlockPx && strip_px * row_texels > kStripTexelsMax) strip_px /= 2;
  return strip_px;
}

uint32_t MeanColorPass::formatOf(const StructureSlot& structure, const ColorReach& reach) {
  return isAveraged(structure, reach) ? abi::kColorCodes11
                                      : colorFormat(structure.shape().color_storage);
}

std::array<MeanColorPass::Axis, 2> MeanColorPass::axesOf(const StructureSlot& structure,
                                                         const ColorReach& reach) {
  return {Axis{true, reach.y_px, colorFormat(structure.shape().color_storage)},
          Axis{false, reach.x_px, abi::kColorCodes11}};
}

void MeanColorPass::addMissing(const StructureSlot& structure, const ColorReach& reach,
                               MissingKernels& missing) {
  if (!isAveraged(structure, reach)) return;
  for (const Axis& axis : axesOf(structure, reach)) {
    passes_.addMissing(variantOf(structure, axis), missing);
  }
}

MeanColorPass::Averages MeanColorPass::averagesOf(const StructureSlot& structure,
                                                  const ColorReach& reach) {
  const auto [y, x] = axesOf(structure, reach);
  return {Average{y, passes_.get(variantOf(structure, y))},
          Average{x, passes_.get(variantOf(structure, x))}};
}

MeanColorPass::Color MeanColorPass::record(Commands commands, const StructureSlot& structure,
                                           const ColorReach& reach) {
  const uint32_t format = formatOf(structure, reach);
  if (!isAveraged(structure, reach)) return {structure.color(), format};
  const Averages averages = averagesOf(structure, reach);  // not under the lock: may compile
  std::lock_guard lock(mutex_);
  MeanColor::Planes& planes = structure.meanColor().planesFor(reach);
  recordMeans(commands, structure, averages, structure.shape().depth_px.height, planes);
  return {planes.means, format};
}

uint64_t MeanColorPass::recordRows(Commands commands, const StructureSlot& structure,
                                   const ColorReach& reach, uint64_t texel_count_max) {
  if (!isAveraged(structure, reach)) return 0;
  const Averages averages = averagesOf(structure, reach);
  std::lock_guard lock(mutex_);
  MeanColor::Planes& planes = structure.meanColor().planesFor(reach);
  const uint64_t row_texels =
      uint64_t{structure.shape().depth_px.width} * structure.shape().layerCount();
  const uint32_t before = planes.made_row_count;
  recordMeans(commands, structure, averages, uint32_t(texel_count_max / row_texels), planes);
  return (planes.made_row_count - before) * row_texels;
}

// All rows that are left, or whole strips of rows: one strip at least.
void MeanColorPass::recordMeans(Commands commands, const StructureSlot& structure,
                                const Averages& averages, uint32_t row_count,
                                MeanColor::Planes& planes) {
  const uint32_t strip_px = stripPx(structure);
  const uint32_t left = structure.shape().depth_px.height - planes.made_row_count;
  if (left == 0) return;
  const uint32_t whole = std::max(row_count / strip_px, 1U) * strip_px;
  const Rows rows{planes.made_row_count, row_count < left ? std::min(whole, left) : left};
  const LayeredBuffer& along_y = structure.meansAlongY();
  // Others may have been made by way of the same memory before.
  recordComputeBarrier(commands);
  recordAlong(commands, structure, averages[0], rows, structure.color(), along_y);
  recordComputeBarrier(commands);
  recordAlong(commands, structure, averages[1], rows, along_y, planes.means);
  recordComputeBarrier(commands);
  planes.made_row_count += rows.count;
}

void MeanColorPass::recordAlong(Commands commands, const StructureSlot& structure,
                                const Average& average, Rows rows, const LayeredBuffer& from,
                                const LayeredBuffer& to) {
  const Axis& axis = average.axis;
  const uint32_t strip_px = stripPx(structure);
  const SizePx size_px = structure.shape().depth_px;
  const uint32_t layer_count = structure.shape().layerCount();
  abi::AveragePush push{.layers = {},
                        .from = {},
                        .to = {},
                        .size_px = packSize(size_px),
                        .last_weight = tapWeight(axis.reach_px, tapCount(axis.reach_px)),
                        .first_strip = axis.is_y ? rows.first / strip_px : rows.first};
  for (uint32_t i = 0; i < layer_count; ++i) {
    push.layers[i] = addressWords(structure.structure().address(i));
    push.from[i] = addressWords(from.address(i));
    push.to[i] = addressWords(to.address(i));
  }
  const Descriptor descriptors[] = {
      structure.structure().asTexels(abi::kBindingStructure),
      structure.structure().asHalfTexels(abi::kBindingStructureHalves),
      from.asTexels(abi::kBindingColor), to.asStorage(abi::kBindingMeans)};
  average.pass.recordDescriptors(commands, descriptors);
  const auto stripCount = [&](uint32_t length_px) { return (length_px + strip_px - 1) / strip_px; };
  const SizePx strips = axis.is_y ? SizePx{size_px.width, stripCount(rows.count)}
                                  : SizePx{stripCount(size_px.width), rows.count};
  // A software device gives each core a run of groups: layers come first, as deeper ones cost less.
  average.pass.record(commands, push, layer_count, groupCount(strips.width), strips.height);
}

}  // namespace viewloom
