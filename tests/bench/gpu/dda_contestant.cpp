// SPDX-License-Identifier: Apache-2.0
// Steps every ray from px to px (shaders/dda_views.comp).
#include <optional>

#include "bench/gpu/atlas_pass.h"
#include "bench/gpu/gpu_rivals.h"
#include "bench/gpu/inv_z_build.h"
#include "shaders/dda_views.h"

namespace viewloom::bench {
namespace {

constexpr DescriptorSlot kSlots[] = {{abi::kBindingColor, DescriptorKind::kTexels},
                                     {abi::kBindingInvZ, DescriptorKind::kTexels}};

class Dda final : public Contestant {
 public:
  explicit Dda(const Device& device) : device_(device), timeline_(device), recorder_(device) {}

  std::string_view name() const override { return "dda"; }
  bool takes(const BenchLoad& load) const override { return fitsAtlasPass(device_, load); }
  void prepare(const BenchLoad& load) override {
    source_.emplace(device_, load);
    atlas_.emplace(device_, load, dda_views_spirv, kSlots, "dda");
    atlas_->bind(source_->colorAndInvZ());
  }
  void build() override {
    source_->record(recorder_.begin());
    timeline_.wait(recorder_.submit(timeline_));
  }
  void trace() override { atlas_->trace(); }
  Picture picture() override { return atlas_->picture(); }

 private:
  const Device& device_;
  Timeline timeline_;
  CommandRecorder recorder_;
  std::optional<InvZBuild> source_;
  std::optional<AtlasPass> atlas_;
};

}  // namespace

std::unique_ptr<Contestant> makeDda(const Device& device) {
  return std::make_unique<Dda>(device);
}

}  // namespace viewloom::bench
