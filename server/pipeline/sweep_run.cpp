// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sweep_run.h"

#include <algorithm>
#include <utility>

namespace viewloom {
namespace {

// So short that an atlas that is due sooner need not wait, long enough that threads seldom meet.
constexpr uint32_t kRowsPerPiece = 16;

uint32_t piecesOf(const SweepPlan& plan) {
  return (plan.rowCount() + kRowsPerPiece - 1) / kRowsPerPiece;
}

}  // namespace

SweepRun::SweepRun(AtlasRunPtr run, SweepPlan plan, std::shared_ptr<SweptAtlas> atlas)
    : run_(std::move(run)),
      plan_(std::move(plan)),
      atlas_(std::move(atlas)),
      piece_count_(piecesOf(plan_)) {
  atlas_->begin(*run_->picture, run_->planes);
}

Coverage SweepRun::sweepPiece(uint32_t piece, ViewSweeper& sweeper) {
  const SweepSource& source = run_->job.structure->build->swept;
  const uint32_t first = piece * kRowsPerPiece;
  return sweeper.sweepRows({.job = run_->picture.get(),
                            .plan = &plan_,
                            .source = source.rowSource(),
                            .inv_z_max = float(source.measured().stats.inv_z_max)},
                           first, std::min(kRowsPerPiece, plan_.rowCount() - first), run_->planes,
                           *atlas_);
}

}  // namespace viewloom
