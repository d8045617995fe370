// SPDX-License-Identifier: Apache-2.0
#include "sweep/sweep_engine.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "sweep/sweep_plan.h"
#include "sweep/sweep_source.h"

namespace viewloom {
namespace {

// All threads sweep one tracked display of a payer at a time. The eyes of the next display are
// taken when its turn comes.
constexpr size_t kAtlasesForEyes = 1;
// Largest atlas of which each picture may always have one: some 10 MB.
constexpr uint64_t kSmallAtlas_px = uint64_t{1} << 20;
// So long that threads seldom meet. Rows of large atlases take longer: then a piece has fewer.
constexpr uint32_t kRowsPerPieceMax = 16;
// Time of a px of an atlas until something was measured.
constexpr double kPxStart_ns = 50;

class SweptFrame final : public PreparedFrame {
 public:
  SweptFrame(WorkerPool& workers, MemoryBudget& memory) : workers_(workers), memory_(memory) {}

  void take(FramePtr frame) override { frame_ = std::move(frame); }
  void reserve() override {
    const uint64_t wanted_bytes = SweepSource::bytesFor(frame_->format);
    if (reserved_.bytes() == wanted_bytes) return;
    source_ = SweepSource();
    reserved_.release();
    absl::StatusOr<Reservation> reserved = memory_.reserve(
        {.use = MemoryUse::kStructures, .identity = frame_->publisher, .bytes = wanted_bytes},
        "preparing the frame", [](uint64_t) { return "Publish smaller frames or fewer layers"; });
    if (!reserved.ok()) throw EngineOutOfMemory(std::string(reserved.status().message()));
    reserved_ = *std::move(reserved);
  }
  // All workers take its pieces, between which they serve others.
  int64_t prepare(const Clock&, const PreparationEvents&) override {
    if (!frame_) return 0;
    reserve();
    source_.prepare(std::move(frame_), workers_);
    return 0;
  }
  FrameMeasures measures() const override {
    return {.stats = source_.measured().stats, .depths = source_.measured().depths};
  }
  const SweepSource& source() const { return source_; }

 private:
  WorkerPool& workers_;
  MemoryBudget& memory_;
  Reservation reserved_;
  FramePtr frame_;      // that is not prepared yet
  SweepSource source_;  // keeps the last frame that was prepared until the next one is
};

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

const SweepSource& sourceOf(const PreparedFrame& frame) {
  return static_cast<const SweptFrame&>(frame).source();
}

struct PictureSweep final : Plan {
  PictureSweep(SweepPlan swept_plan, double source_inv_z_max, uint64_t area_px,
               std::shared_ptr<CostEstimate> cost_of_all)
      : plan(std::move(swept_plan)),
        inv_z_max(source_inv_z_max),
        row_px(std::max<uint64_t>(area_px / plan.rowCount(), 1)),
        of_all(std::move(cost_of_all)),
        px_cost(std::make_shared<CostEstimate>(*of_all)) {}

  bool holdsFor(const PreparedFrame& frame) const override {
    return sourceOf(frame).measured().stats.inv_z_max == inv_z_max;
  }

  const SweepPlan plan;
  void note(uint64_t px_count, int64_t measured_ns) const {
    px_cost->note(px_count, measured_ns);
    of_all->note(px_count, measured_ns);
  }

  const double inv_z_max;                       // of the source, 1/m
  const uint64_t row_px;                        // of the atlas, that a row of the plan fills
  const std::shared_ptr<CostEstimate> of_all;   // of a px of all pictures
  const std::shared_ptr<CostEstimate> px_cost;  // of this picture
};

// How the rows of a plan are cut into pieces of bounded work: some rows each, and of a pair of rows
// that takes too long, some rows of the grid of tiles.
struct SweepPieces {
  SweepPieces(const PictureSweep& sweep, const AtlasLayout& layout, ColorForm form)
      : grid_row_count(layout.rows) {
    const uint64_t px_max = sweep.px_cost->unitsFor(kPiece_ns);
    // Pairs of rows stay together.
    while (row_count > 2 && row_count * sweep.row_px > px_max) row_count /= 2;
    const auto pxOfPiece = [&] { return row_count * sweep.row_px * grid_row_count / layout.rows; };
    if (ViewSweeper::canShareTiles(sweep.plan, layout, form)) {
      while (grid_row_count > 1 && pxOfPiece() > px_max) grid_row_count = (grid_row_count + 1) / 2;
    }
    grid_piece_count = (layout.rows + grid_row_count - 1) / grid_row_count;
    piece_count = (sweep.plan.rowCount() + row_count - 1) / row_count * grid_piece_count;
    px_count = pxOfPiece();
    piece_ns = sweep.px_cost->predictNs(px_count);
  }

  uint32_t row_count = kRowsPerPieceMax;  // of a piece
  uint32_t grid_row_count;                // likewise
  uint32_t grid_piece_count = 1;          // pieces of the same rows
  uint32_t piece_count = 0;
  uint64_t px_count = 0;  // of a piece, at most
  int64_t piece_ns = 0;
};

// The whole atlas at once: its rows lie all over it.
class AtlasSweep final : public StripWork {
 public:
  AtlasSweep(const SweepPieces& pieces, AtlasOrder order, TraceOutputs planes,
             std::shared_ptr<HeldAtlas> atlas, std::shared_ptr<SweeperShelf> sweepers)
      : StripWork({.strip_count = order.strips.count(),
                   .piece_count = pieces.piece_count,
                   .piece_ns = pieces.piece_ns,
                   .begins_with_one = true}),
        pieces_(pieces),
        order_(std::move(order)),
        planes_(planes),
        atlas_(std::move(atlas)),
        sweepers_(std::move(sweepers)) {}

  static const PictureSweep& sweepOf(const AtlasOrder& order) {
    return static_cast<const PictureSweep&>(*order.plan);
  }

  void notePiece(int64_t measured_ns) override {
    sweepOf(order_).note(pieces_.px_count, measured_ns);
  }

  // The first one takes memory for all; each touches what it writes.
  void makePiece(uint32_t piece) override {
    if (piece == 0) atlas_->planes.begin(*order_.picture, planes_);
    const SweepPlan& plan = sweepOf(order_).plan;
    const SweepSource& source = sourceOf(*order_.frames.front());
    const uint32_t first = piece / pieces_.grid_piece_count * pieces_.row_count;
    const uint32_t first_in_grid = piece % pieces_.grid_piece_count * pieces_.grid_row_count;
    const uint32_t end_in_grid =
        std::min(first_in_grid + pieces_.grid_row_count, order_.picture->layout->rows);
    std::unique_ptr<ViewSweeper> sweeper = sweepers_->take();
    const Coverage coverage =
        sweeper->sweepRows({.job = order_.picture.get(),
                            .plan = &plan,
                            .source = source.rowSource(),
                            .inv_z_max = float(source.measured().stats.inv_z_max)},
                           first, std::min(pieces_.row_count, plan.rowCount() - first),
                           {first_in_grid, end_in_grid}, planes_, atlas_->planes);
    sweepers_->putBack(std::move(sweeper));
    std::lock_guard lock(mutex_);
    counts_.coverage.add(coverage);
  }

  RayCounts counts() const override {
    std::lock_guard lock(mutex_);
    return counts_;
  }

  StripPlanes planes(uint32_t strip) const override {
    const SizePx size_px = order_.picture->layout->size_px;
    const BandRows rows = order_.strips.rowsOf(strip);
    const auto rowsOf = [&]<typename T>(const UntouchedVector<T>& plane) {
      if (plane.empty()) return std::span<const T>();
      return std::span<const T>(plane).subspan(size_t{rows.first_row} * size_px.width,
                                               size_t{rows.row_count} * size_px.width);
    };
    return {.rgba = atlas_->planes.color,
            .ycbcr = atlas_->planes.ycbcr,
            .color_px = size_px,
            .first_row = rows.first_row,
            .depth = rowsOf(atlas_->planes.depth),
            .mask = rowsOf(atlas_->planes.mask)};
  }

 private:
  const SweepPieces pieces_;
  const AtlasOrder order_;
  const TraceOutputs planes_;
  const std::shared_ptr<HeldAtlas> atlas_;  // holding it keeps it from reuse
  const std::shared_ptr<SweeperShelf> sweepers_;
  mutable std::mutex mutex_;
  RayCounts counts_;  // guarded by mutex_
};

// Hands everything on in its only step.
class SweepMaking final : public Making {
 public:
  SweepMaking(AtlasOrder order, const TraceOutputs& planes, std::shared_ptr<HeldAtlas> atlas,
              std::shared_ptr<SweeperShelf> sweepers, HandOn hand_on)
      : planes_(planes), hand_on_(std::move(hand_on)) {
    const SweepPieces pieces(AtlasSweep::sweepOf(order), *order.picture->layout, planes_.color);
    work_ = std::make_unique<AtlasSweep>(pieces, std::move(order), planes_, std::move(atlas),
                                         std::move(sweepers));
  }

  const TraceOutputs& planes() const override { return planes_; }
  bool holdsRoom() const override { return work_ != nullptr; }
  MakingStep step() override {
    hand_on_(std::move(work_));
    return {.is_last = true};
  }
  void giveUp() override {}

 private:
  TraceOutputs planes_;
  const HandOn hand_on_;
  StripWorkPtr work_;
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
  planes.color = AtlasSweep::sweepOf(order).plan.colorForm(planes.color);
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
  return std::make_unique<SweepMaking>(std::move(order), planes, std::move(atlas), sweepers_,
                                       std::move(hand_on));
}

}  // namespace viewloom
