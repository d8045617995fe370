// SPDX-License-Identifier: Apache-2.0
#include "sweep/sweep_making.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "sweep/picture_sweep.h"

namespace viewloom {
namespace {

// So long that threads seldom meet. Rows of large atlases take longer: then a piece has fewer.
constexpr uint32_t kRowsPerPieceMax = 16;

// How the rows of a plan are cut into pieces of bounded work: some rows each, and of a pair of rows
// that takes too long, some rows of the grid of tiles. `rows`: of that grid, all that are swept.
struct SweepPieces {
  SweepPieces(const PictureSweep& sweep, const AtlasLayout& layout, ColorForm form, GridRows rows)
      : grid(rows), grid_row_count(rows.end - rows.first) {
    const uint64_t px_max = sweep.px_cost->unitsFor(kPiece_ns);
    // Pairs of rows stay together.
    while (row_count > 2 && row_count * sweep.row_px > px_max) row_count /= 2;
    const auto pxOfPiece = [&] { return row_count * sweep.row_px * grid_row_count / layout.rows; };
    if (ViewSweeper::canShareTiles(sweep.plan, layout, form)) {
      while (grid_row_count > 1 && pxOfPiece() > px_max) grid_row_count = (grid_row_count + 1) / 2;
    }
    grid_piece_count = (rows.end - rows.first + grid_row_count - 1) / grid_row_count;
    piece_count = (sweep.plan.rowCount() + row_count - 1) / row_count * grid_piece_count;
    px_count = pxOfPiece();
    piece_ns = sweep.px_cost->predictNs(px_count);
  }

  GridRows grid;
  uint32_t row_count = kRowsPerPieceMax;  // of a piece
  uint32_t grid_row_count;                // likewise
  uint32_t grid_piece_count = 1;          // pieces of the same rows
  uint32_t piece_count = 0;
  uint64_t px_count = 0;  // of a piece, at most
  int64_t piece_ns = 0;
};

// Sweeps of a video's stack of pictures. Each row of the source is prepared once in each, but the
// first pictures leave while others are swept.
constexpr uint32_t kStackSweepCount = 3;

// An atlas that is swept at once, or image by image. Whoever sweeps first takes memory for all.
struct SweptPlanes {
  std::shared_ptr<HeldAtlas> atlas;  // holding it keeps it from reuse
  std::once_flag has_begun;
};

// Images at the places [first, end) of their order, at once: their rows lie all over them.
struct SweptImages {
  uint32_t first = 0;
  uint32_t end = 1;
};

class AtlasSweep final : public StripWork {
 public:
  AtlasSweep(const SweepPieces& pieces, SweptImages images, AtlasOrder order, TraceOutputs planes,
             std::shared_ptr<SweptPlanes> swept, std::shared_ptr<SweeperShelf> sweepers)
      : StripWork({.first_strip = images.first * order.strips.perImage(),
                   .strip_count = (images.end - images.first) * order.strips.perImage(),
                   .piece_count = pieces.piece_count,
                   .piece_ns = pieces.piece_ns,
                   .begins_with_one = true}),
        pieces_(pieces),
        order_(std::move(order)),
        planes_(planes),
        swept_(std::move(swept)),
        sweepers_(std::move(sweepers)) {}

  void notePiece(int64_t measured_ns) override {
    sweepOf(order_).note(pieces_.px_count, measured_ns);
  }

  // Each piece touches what it writes.
  void makePiece(uint32_t piece) override {
    SweptAtlas& atlas = swept_->atlas->planes;
    std::call_once(swept_->has_begun, [&] { atlas.begin(*order_.picture, planes_); });
    const SweepPlan& plan = sweepOf(order_).plan;
    const SweepSource& source = sourceOf(*order_.frames.front());
    const uint32_t first = piece / pieces_.grid_piece_count * pieces_.row_count;
    const uint32_t first_in_grid =
        pieces_.grid.first + piece % pieces_.grid_piece_count * pieces_.grid_row_count;
    const uint32_t end_in_grid = std::min(first_in_grid + pieces_.grid_row_count, pieces_.grid.end);
    std::unique_ptr<ViewSweeper> sweeper = sweepers_->take();
    const Coverage coverage =
        sweeper->sweepRows({.job = order_.picture.get(),
                            .plan = &plan,
                            .source = source.rowSource(),
                            .inv_z_max = float(source.measured().stats.inv_z_max)},
                           first, std::min(pieces_.row_count, plan.rowCount() - first),
                           {first_in_grid, end_in_grid}, planes_, atlas);
    sweepers_->putBack(std::move(sweeper));
    std::lock_guard lock(mutex_);
    counts_.coverage.add(coverage);
  }

  RayCounts counts() const override {
    std::lock_guard lock(mutex_);
    return counts_;
  }

  StripPlanes planes(uint32_t strip) const override {
    const SweptAtlas& atlas = swept_->atlas->planes;
    const SizePx size_px = order_.picture->layout->size_px;
    const BandRows rows = order_.strips.rowsOf(strip);
    const auto rowsOf = [&]<typename T>(const UntouchedVector<T>& plane) {
      if (plane.empty()) return std::span<const T>();
      return std::span<const T>(plane).subspan(size_t{rows.first_row} * size_px.width,
                                               size_t{rows.row_count} * size_px.width);
    };
    return {.rgba = atlas.color,
            .ycbcr = atlas.ycbcr,
            .color_px = size_px,
            .first_row = rows.first_row,
            .depth = rowsOf(atlas.depth),
            .mask = rowsOf(atlas.mask)};
  }

 private:
  const SweepPieces pieces_;
  const AtlasOrder order_;
  const TraceOutputs planes_;
  const std::shared_ptr<SweptPlanes> swept_;
  const std::shared_ptr<SweeperShelf> sweepers_;
  mutable std::mutex mutex_;
  RayCounts counts_;  // guarded by mutex_
};

// Images that are swept together, in order. Other atlases than stacks are swept at once: each row
// of the source is then prepared once.
std::vector<SweptImages> sweptImages(const AtlasLayout& layout) {
  if (!layout.stack) return {SweptImages{.first = 0, .end = layout.image_count}};
  const uint32_t count = std::min(kStackSweepCount, layout.image_count);
  std::vector<SweptImages> sweeps;
  for (uint32_t i = 0; i < count; ++i) {
    sweeps.push_back({layout.image_count * i / count, layout.image_count * (i + 1) / count});
  }
  return sweeps;
}

// Rows of tiles of these images.
GridRows gridRowsOf(const AtlasLayout& layout, const AtlasStrips& strips, SweptImages images) {
  const uint32_t per_image = layout.stack ? layout.stack->rows : 0;
  if (per_image == 0) return {0, layout.rows};
  const uint32_t one = strips.imageAt(images.first);
  const uint32_t other = strips.imageAt(images.end - 1);
  return {std::min(one, other) * per_image, (std::max(one, other) + 1) * per_image};
}

}  // namespace

SweepMaking::SweepMaking(const AtlasOrder& order, const TraceOutputs& planes,
                         std::shared_ptr<HeldAtlas> atlas,
                         const std::shared_ptr<SweeperShelf>& sweepers, HandOn hand_on)
    : planes_(planes), hand_on_(std::move(hand_on)) {
  const AtlasLayout& layout = *order.picture->layout;
  const auto swept = std::make_shared<SweptPlanes>();
  swept->atlas = std::move(atlas);
  for (const SweptImages images : sweptImages(layout)) {
    const SweepPieces pieces(sweepOf(order), layout, planes_.color,
                             gridRowsOf(layout, order.strips, images));
    works_.push_back(std::make_unique<AtlasSweep>(pieces, images, order, planes_, swept, sweepers));
  }
}

MakingStep SweepMaking::step() {
  std::vector<StripWorkPtr> works;
  works.swap(works_);
  for (StripWorkPtr& work : works) hand_on_(std::move(work));
  return {.is_last = true};
}

}  // namespace viewloom
