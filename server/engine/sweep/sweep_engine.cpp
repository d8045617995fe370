// SPDX-License-Identifier: Apache-2.0
#include "sweep/sweep_engine.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "sweep/picture_sweep.h"
#include "sweep/sweep_making.h"
#include "sweep/swept_frame.h"

namespace viewloom {
namespace {

// All threads sweep one tracked display of a payer at a time. The eyes of the next display are
// taken when its turn comes.
constexpr size_t kAtlasesForEyes = 1;
// Largest atlas of which each picture may always have one: some 10 MB.
constexpr uint64_t kSmallAtlas_px = uint64_t{1} << 20;
// Time of a px of an atlas until something was measured.
constexpr double kPxStart_ns = 50;

class SweptFramePreparer final : public FramePreparer {
 public:
  SweptFramePreparer(WorkerPool& workers, MemoryBudget& memory)
      : workers_(workers), memory_(memory) {}
  std::unique_ptr<PreparedFrame> make() override {
    return std::make_unique<SweptFrame>(workers_, memory_);
  }

 private:
  WorkerPool& workers_;
  MemoryBudget& memory_;
};

}  // namespace

std::unique_ptr<ViewSweeper> SweeperShelf::take() {
  std::lock_guard lock(mutex_);
  if (free_.empty()) return std::make_unique<ViewSweeper>();
  std::unique_ptr<ViewSweeper> sweeper = std::move(free_.back());
  free_.pop_back();
  return sweeper;
}

void SweeperShelf::putBack(std::unique_ptr<ViewSweeper> sweeper) {
  std::lock_guard lock(mutex_);
  free_.push_back(std::move(sweeper));
}

SweepEngine::SweepEngine(uint32_t atlas_count, WorkerPool& workers, MemoryBudget& memory)
    : workers_(workers),
      memory_(memory),
      sweepers_(std::make_shared<SweeperShelf>()),
      atlases_(atlas_count, [this] { events_.on_room(); }),
      atlases_for_eyes_(kAtlasesForEyes, [this] { events_.on_room(); }),
      px_cost_(std::make_shared<CostEstimate>(kPxStart_ns)) {
  memory_.addIdle(atlases_.idleMemory());
  memory_.addIdle(atlases_for_eyes_.idleMemory());
}

bool SweepEngine::takes(const Frame& frame) const {
  return canSweep(frame);
}

std::unique_ptr<FramePreparer> SweepEngine::preparer() {
  return std::make_unique<SweptFramePreparer>(workers_, memory_);
}

uint64_t SweepEngine::preparedBytes(const FrameFormat& format) const {
  return canSweep(format) ? SweepSource::bytesFor(format) : 0;
}

PlanPtr SweepEngine::plan(const PicturePtr& picture, const PreparedFrame& frame) const {
  const double inv_z_max = sourceOf(frame).measured().stats.inv_z_max;
  std::optional<SweepPlan> plan = SweepPlan::make(*picture, inv_z_max);
  if (!plan) return nullptr;
  return std::make_shared<PictureSweep>(*std::move(plan), inv_z_max,
                                        picture->layout->size_px.area(), px_cost_);
}

std::unique_ptr<Making> SweepEngine::begin(AtlasOrder order, HandOn hand_on) {
  const bool is_small = order.picture->layout->size_px.area() <= kSmallAtlas_px;
  const std::string& key = is_small && !order.is_for_eyes ? order.picture_key : order.payer;
  AtlasPool& pool = order.is_for_eyes ? atlases_for_eyes_ : atlases_;
  const bool are_others_lent = atlases_.lentCount() + atlases_for_eyes_.lentCount() > 0;
  TraceOutputs planes = order.planes;
  planes.color = sweepOf(order).plan.colorForm(planes.color);
  std::shared_ptr<HeldAtlas> atlas = pool.take(key, *order.picture, planes);
  if (!atlas) return nullptr;
  if (!atlas->makeRoom(memory_, *order.picture, planes)) {
    if (are_others_lent) {
      pool.putAside(std::move(atlas));
      return nullptr;
    }
    throw EngineOutOfMemory(
        "the server's memory.budget has no room left for an atlas of this size; choose a smaller "
        "one, or try again later");
  }
  return std::make_unique<SweepMaking>(order, planes, std::move(atlas), sweepers_,
                                       std::move(hand_on));
}

}  // namespace viewloom
