// SPDX-License-Identifier: Apache-2.0
// Walks a min/max pyramid (shaders/build_boxes.comp, shaders/hiz_views.comp).
#include <optional>

#include "bench/gpu/atlas_pass.h"
#include "bench/gpu/gpu_rivals.h"
#include "bench/gpu/inv_z_build.h"
#include "gpu/commands.h"
#include "shaders/build_boxes.h"
#include "shaders/hiz_views.h"
#include "shared/kernel_constants.h"

namespace viewloom::bench {
namespace {

constexpr DescriptorSlot kWalkSlots[] = {{abi::kBindingColor, DescriptorKind::kTexels},
                                         {abi::kBindingInvZ, DescriptorKind::kTexels},
                                         {abi::kBindingBoxes, DescriptorKind::kTexels}};
constexpr DescriptorSlot kBuildSlots[] = {{abi::kBindingInvZ, DescriptorKind::kTexels},
                                          {abi::kBindingBoxes, DescriptorKind::kTexels},
                                          {abi::kBindingBoxesOut, DescriptorKind::kStorage}};

constexpr uint64_t kBoxBytes = 4;
// Levels that a pass adds to the highest one.
constexpr uint32_t kLevelsPerPass = 2;
static_assert(abi::kBoxLevelLast % kLevelsPerPass == 0);

SizePx paddedSize(SizePx size_px) {
  const uint32_t mask = (1u << abi::kBoxLevelLast) - 1;
  return {(size_px.width + mask) & ~mask, (size_px.height + mask) & ~mask};
}

// Boxes of a layer, up to where the binding of the next may begin on any device: 256 bytes.
uint64_t boxStride(SizePx size_px) {
  const uint64_t last_count = paddedSize(size_px).area() >> (2 * abi::kBoxLevelLast);
  const uint64_t all_levels = last_count * ((uint64_t{4} << (2 * abi::kBoxLevelLast)) - 1) / 3;
  return (all_levels + 63) / 64 * 64;
}

ComputePass makeBuild(const Device& device, uint32_t from_inv_z) {
  const KernelConstant constant{abi::kIdFree, from_inv_z};
  return ComputePass(device, {.spirv = build_boxes_spirv,
                              .push_bytes = sizeof(abi::BoxesPush),
                              .constants = {&constant, 1},
                              .descriptors = kBuildSlots,
                              .debug_name = "build boxes"});
}

class HiZ final : public Contestant {
 public:
  explicit HiZ(const Device& device)
      : device_(device),
        timeline_(device),
        recorder_(device),
        from_inv_z_(makeBuild(device, 1)),
        from_boxes_(makeBuild(device, 0)) {}

  std::string_view name() const override { return "hiz"; }
  bool takes(const BenchLoad& load) const override {
    const uint64_t boxes = boxStride(load.source.size_px);
    return fitsAtlasPass(device_, load) &&
           boxes * kBoxBytes <= device_.info().limits.storage_bytes_max &&
           boxes * load.source.inv_z.size() <= device_.info().limits.texel_count_max;
  }
  void prepare(const BenchLoad& load) override;
  void build() override;
  void trace() override { atlas_->trace(); }
  Picture picture() override { return atlas_->picture(); }

 private:
  void recordLevels(Commands commands, uint32_t layer, uint32_t level) const;

  const Device& device_;
  Timeline timeline_;
  CommandRecorder recorder_;
  ComputePass from_inv_z_;
  ComputePass from_boxes_;
  const BenchLoad* load_ = nullptr;
  std::optional<InvZBuild> source_;
  Buffer boxes_;
  TexelView box_texels_;
  std::optional<AtlasPass> atlas_;
};

void HiZ::prepare(const BenchLoad& load) {
  load_ = &load;
  source_.emplace(device_, load);
  const uint64_t stride = boxStride(load.source.size_px);
  boxes_ = Buffer(device_, {.size_bytes = stride * load.source.inv_z.size() * kBoxBytes,
                            .debug_name = "boxes"});
  box_texels_ = TexelView(device_, boxes_, TexelFormat::kR32Uint);
  atlas_.emplace(device_, load, hiz_views_spirv, kWalkSlots, "hiz");
  std::vector<Descriptor> descriptors = source_->colorAndInvZ();
  descriptors.push_back(
      {.binding = abi::kBindingBoxes, .kind = DescriptorKind::kTexels, .texels = &box_texels_});
  atlas_->bind(std::move(descriptors), uint32_t(stride));
}

void HiZ::build() {
  const Commands commands = recorder_.begin();
  source_->record(commands);
  for (uint32_t level = 0; level < abi::kBoxLevelLast; level += kLevelsPerPass) {
    for (uint32_t layer = 0; layer < load_->source.inv_z.size(); ++layer) {
      recordLevels(commands, layer, level);
      recordComputeBarrier(commands);  // all layers lie in what is bound as texels
    }
  }
  timeline_.wait(recorder_.submit(timeline_));
}

void HiZ::recordLevels(Commands commands, uint32_t layer, uint32_t level) const {
  const SizePx size_px = load_->source.size_px;
  const SizePx padded_px = paddedSize(size_px);
  const uint64_t stride = boxStride(size_px);
  const ComputePass& pass = level == 0 ? from_inv_z_ : from_boxes_;
  pass.recordDescriptors(
      commands,
      std::vector<Descriptor>{
          source_->slot().invZ().asTexels(abi::kBindingInvZ),
          {.binding = abi::kBindingBoxes, .kind = DescriptorKind::kTexels, .texels = &box_texels_},
          {.binding = abi::kBindingBoxesOut,
           .kind = DescriptorKind::kStorage,
           .buffer = &boxes_,
           .offset_bytes = layer * stride * kBoxBytes,
           .size_bytes = stride * kBoxBytes}});
  const uint32_t columns = padded_px.width >> (level + kLevelsPerPass);
  pass.record(commands,
              abi::BoxesPush{.source_size_px = size_px.width | size_px.height << 16,
                             .layer = layer,
                             .level = level,
                             .box_stride = uint32_t(stride),
                             .kappa = {load_->source.kappa.least, load_->source.kappa.share,
                                       load_->source.kappa.from}},
              (columns + abi::kNodeGroupSize - 1) / abi::kNodeGroupSize,
              padded_px.height >> (level + kLevelsPerPass));
}

}  // namespace

std::unique_ptr<Contestant> makeHiZ(const Device& device) {
  return std::make_unique<HiZ>(device);
}

}  // namespace viewloom::bench
