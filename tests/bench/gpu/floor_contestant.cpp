// SPDX-License-Identifier: Apache-2.0
// Shades hits of viewloom's own walk, which are found beforehand (shaders/floor_views.comp).
#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "bench/gpu/atlas_pass.h"
#include "bench/gpu/gpu_rivals.h"
#include "gpu/commands.h"
#include "shaders/floor_views.h"
#include "structure/structure_builder.h"
#include "trace/view_tracer.h"

namespace viewloom::bench {
namespace {

constexpr DescriptorSlot kSlots[] = {{abi::kBindingColor, DescriptorKind::kTexels},
                                     {abi::kBindingStructure, DescriptorKind::kTexels},
                                     {abi::kBindingStructureHalves, DescriptorKind::kTexels},
                                     {abi::kBindingHits, DescriptorKind::kTexels}};

constexpr uint32_t kBandRows = 64;

bool isHit(const abi::RayRecord& record) {
  return record.ray_class == abi::kClassHit || record.ray_class == abi::kClassHitAssumed;
}

// `code`: what viewloom made of it. A record does not name the px, which is the one that the
// position lies in; on an edge both have the same colour, as linked surfaces alone are hit there.
abi::uvec2 packHit(const abi::RayRecord& record, uint32_t code, SizePx size_px) {
  if (!isHit(record)) return {code, 0};
  const auto column = std::min(uint32_t(std::max(record.x_px, 0.0F)), size_px.width - 1);
  const auto row = std::min(uint32_t(std::max(record.y_px, 0.0F)), size_px.height - 1);
  const auto steps = [](float position_px, uint32_t pixel) {
    return uint32_t(std::clamp(std::nearbyint((position_px - float(pixel)) * 256), 0.0F, 256.0F));
  };
  return {column | row << 16, abi::kHitExists | record.layer |
                                  steps(record.x_px, column) << abi::kHitOffsetXShift |
                                  steps(record.y_px, row) << abi::kHitOffsetYShift};
}

class Floor final : public Contestant {
 public:
  explicit Floor(const Device& device)
      : device_(device), timeline_(device), recorder_(device), builder_(device), tracer_(device) {}

  std::string_view name() const override { return "floor"; }
  bool takes(const BenchLoad& load) const override {
    const DeviceLimits& limits = device_.info().limits;
    const uint64_t rays = load.job.layout->size_px.area();
    const FrameShape shape = shapeOf(*load.frame);
    const uint64_t structure_bytes =
        structureLayout(shape.depth_px).layerBytes() * shape.layerCount();
    return fitsAtlasPass(device_, load) && rays <= limits.texel_count_max &&
           rays * sizeof(abi::uvec2) <= limits.allocation_bytes_max &&
           structure_bytes <= limits.allocation_bytes_max &&
           structure_bytes / sizeof(uint32_t) <= limits.texel_count_max;
  }
  void prepare(const BenchLoad& load) override {
    structure_.emplace(device_, shapeOf(*load.frame));
    structure_->upload(*load.frame);
    builder_.record(recorder_.begin(), *structure_, nullptr);
    timeline_.wait(recorder_.submit(timeline_));
    findHits(load);
    atlas_.emplace(device_, load, floor_views_spirv, kSlots, "floor");
    atlas_->bind(
        {structure_->color().asTexels(abi::kBindingColor),
         structure_->structure().asTexels(abi::kBindingStructure),
         structure_->structure().asHalfTexels(abi::kBindingStructureHalves),
         {.binding = abi::kBindingHits, .kind = DescriptorKind::kTexels, .texels = &hit_texels_}});
  }
  void build() override {}
  void trace() override { atlas_->trace(); }
  Picture picture() override {
    Picture picture = atlas_->picture();
    picture.inv_z = inv_z_;
    return picture;
  }

 private:
  void findHits(const BenchLoad& load);

  const Device& device_;
  Timeline timeline_;
  CommandRecorder recorder_;
  StructureBuilder builder_;
  ViewTracer tracer_;
  std::optional<StructureSlot> structure_;
  Buffer hits_;
  TexelView hit_texels_;
  std::vector<float> inv_z_;
  std::optional<AtlasPass> atlas_;
};

void Floor::findHits(const BenchLoad& load) {
  const AtlasLayout& layout = *load.job.layout;
  const uint64_t size_bytes = layout.size_px.area() * sizeof(abi::uvec2);
  const Buffer upload(
      device_,
      {.size_bytes = size_bytes, .intent = MemoryIntent::kUpload, .debug_name = "found hits"});
  TraceSlot traced(device_, {.width_px = layout.size_px.width,
                             .row_count_max = kBandRows,
                             .tile_count_max = uint32_t(load.job.tiles.size()),
                             .outputs = {.records = true}});
  inv_z_.clear();
  std::byte* to = upload.mapped().data();
  for (uint32_t row = 0; row < layout.size_px.height; row += kBandRows) {
    const uint32_t rows = std::min(kBandRows, layout.size_px.height - row);
    tracer_.recordBand(recorder_.begin(), *structure_, load.job, {row, rows}, traced, nullptr);
    timeline_.wait(recorder_.submit(timeline_));
    const std::span<const uint32_t> color = traced.color();
    const std::span<const abi::RayRecord> records = traced.records();
    for (size_t i = 0; i < records.size(); ++i, to += sizeof(abi::uvec2)) {
      const abi::uvec2 hit = packHit(records[i], color[i], load.source.size_px);
      std::memcpy(to, &hit, sizeof hit);
      inv_z_.push_back(isHit(records[i]) ? records[i].inv_z : kNoSurface);
    }
  }
  hits_ = Buffer(device_, {.size_bytes = size_bytes, .debug_name = "known hits"});
  const Commands commands = recorder_.begin();
  commands.copy(upload, hits_, {.size_bytes = size_bytes});
  recordTransferToCompute(commands);
  timeline_.wait(recorder_.submit(timeline_));
  hit_texels_ = TexelView(device_, hits_, TexelFormat::kRg32Uint);
}

}  // namespace

std::unique_ptr<Contestant> makeFloor(const Device& device) {
  return std::make_unique<Floor>(device);
}

}  // namespace viewloom::bench
