// SPDX-License-Identifier: Apache-2.0
#include "bench/gpu/copy_contestant.h"

#include <algorithm>

#include "base/check.h"
#include "bench/gpu/gpu_rivals.h"
#include "gpu/commands.h"
#include "shaders/copy_bytes.h"
#include "structure/structure_slot.h"

namespace viewloom::bench {
namespace {

constexpr DescriptorSlot kSlots[] = {{abi::kBindingFrom, DescriptorKind::kTexels},
                                     {abi::kBindingTo, DescriptorKind::kStorage}};

constexpr uint64_t kUnitBytes = 16;
constexpr uint64_t kAlignedUnits = 256 / kUnitBytes;  // where bindings may begin on any device
// Invocations along the axis of a dispatch that viewloom's own passes have for rows of px.
constexpr uint32_t kRowUnits = 1u << 13;

uint64_t quotientUp(uint64_t count, uint64_t size) {
  return (count + size - 1) / size;
}

// Columns of inv_z, cells and links.
uint64_t builtBytes(const FrameShape& shape) {
  const StructureLayout layout = structureLayout(shape.depth_px);
  return (layout.invZBytes() + layout.layerBytes()) * shape.layerCount();
}

CopyShape shapeOfCopy(uint64_t read_bytes, uint64_t written_bytes, uint64_t binding_bytes_max) {
  const uint64_t read_count = quotientUp(read_bytes, kUnitBytes);
  const uint64_t written_count = quotientUp(written_bytes, kUnitBytes);
  const uint64_t units_max = binding_bytes_max / kUnitBytes / kAlignedUnits * kAlignedUnits;
  const uint64_t part_count = quotientUp(written_count, units_max);
  const uint64_t aligned_count =
      quotientUp(quotientUp(written_count, part_count), kAlignedUnits) * kAlignedUnits;
  VIEWLOOM_CHECK(written_count >= read_count);
  return {.read_count = uint32_t(read_count),
          .part_count = uint32_t(part_count),
          .part_read_count = uint32_t(quotientUp(read_count, part_count)),
          .part_written_count = uint32_t(aligned_count)};
}

}  // namespace

CopyContestant::CopyContestant(const Device& device)
    : device_(device),
      timeline_(device),
      recorder_(device),
      copy_(device, {.spirv = copy_bytes_spirv,
                     .push_bytes = sizeof(abi::CopyPush),
                     .descriptors = kSlots,
                     .debug_name = "copy bytes"}) {}

void CopyContestant::prepare(const BenchLoad& load) {
  const FrameShape shape = viewloom::shapeOf(*load.frame);
  StructureSlot slot(device_, shape);
  slot.upload(*load.frame);
  // Colour that was uploaded to where it is read is not in it: no build need touch that.
  const uint64_t read_bytes = slot.staging().sizeBytes();
  shape_ = shapeOfCopy(read_bytes, builtBytes(shape), device_.info().limits.storage_bytes_max);
  from_ =
      Buffer(device_, {.size_bytes = shape_.read_count * kUnitBytes, .debug_name = "copied from"});
  from_texels_ = TexelView(device_, from_, TexelFormat::kRgba32Uint);
  to_ = Buffer(device_,
               {.size_bytes = uint64_t{shape_.part_count} * shape_.part_written_count * kUnitBytes,
                .debug_name = "copied to"});
  const Commands commands = recorder_.begin();
  commands.copy(slot.staging(), from_, {.size_bytes = read_bytes});
  timeline_.wait(recorder_.submit(timeline_));
}

void CopyContestant::build() {
  const Commands commands = recorder_.begin();
  const uint64_t part_bytes = shape_.part_written_count * kUnitBytes;
  for (uint32_t part = 0; part < shape_.part_count; ++part) {
    const uint32_t first = part * shape_.part_read_count;
    const uint32_t count = std::min(shape_.part_read_count, shape_.read_count - first);
    copy_.recordDescriptors(commands, std::vector<Descriptor>{{.binding = abi::kBindingFrom,
                                                               .kind = DescriptorKind::kTexels,
                                                               .texels = &from_texels_},
                                                              {.binding = abi::kBindingTo,
                                                               .kind = DescriptorKind::kStorage,
                                                               .buffer = &to_,
                                                               .offset_bytes = part * part_bytes,
                                                               .size_bytes = part_bytes}});
    copy_.record(commands,
                 abi::CopyPush{.from_first = first,
                               .from_count = count,
                               .to_count = shape_.part_written_count,
                               .row_count = kRowUnits},
                 kRowUnits / abi::kNodeGroupSize, uint32_t(quotientUp(count, kRowUnits)));
  }
  timeline_.wait(recorder_.submit(timeline_));
}

std::unique_ptr<Contestant> makeCopy(const Device& device) {
  return std::make_unique<CopyContestant>(device);
}

}  // namespace viewloom::bench
