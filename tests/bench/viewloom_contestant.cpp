// SPDX-License-Identifier: Apache-2.0
#include "bench/viewloom_contestant.h"

#include <algorithm>

#include "gpu/commands.h"

namespace viewloom::bench {
namespace {

// A band of any atlas stays within a device's binding.
constexpr uint32_t kBandRowCount = 1024;

BandRows rowsOfBand(uint32_t band, uint32_t height_px) {
  const uint32_t first = band * kBandRowCount;
  return {first, std::min(kBandRowCount, height_px - first)};
}

}  // namespace

ViewloomContestant::ViewloomContestant(const Device& device, bool can_sweep)
    : device_(device),
      can_sweep_(can_sweep),
      timeline_(device),
      recorder_(device),
      builder_(device),
      tracer_(device) {}

bool ViewloomContestant::isSwept(const BenchLoad& load) const {
  return device_.info().is_software && canSweep(*load.frame) &&
         SweepPlan::make(load.job, double{load.source.inv_z_max}).has_value();
}

void ViewloomContestant::prepare(const BenchLoad& load) {
  load_ = &load;
  bands_.clear();
  sweep_.reset();
  if (can_sweep_ && isSwept(load)) {
    auto plan = SweepPlan::make(load.job, double{load.source.inv_z_max});
    sweep_.emplace(Sweep{.plan = *std::move(plan), .source = {}, .sweepers = {}, .atlas = {}});
    build();
    trace();
    return;
  }
  structure_ = std::make_unique<StructureSlot>(device_, shapeOf(*load.frame));
  structure_->upload(*load.frame);
  const SizePx atlas_px = load.job.layout->size_px;
  for (uint32_t row = 0; row < atlas_px.height; row += kBandRowCount) {
    const BandRows rows = rowsOfBand(row / kBandRowCount, atlas_px.height);
    bands_.push_back(std::make_unique<TraceSlot>(
        device_, TraceSlotShape{.width_px = atlas_px.width,
                                .row_count_max = rows.row_count,
                                .tile_count_max = uint32_t(load.job.tiles.size())}));
  }
  build();
  trace();
}

void ViewloomContestant::build() {
  if (sweep_) {
    sweep_->source.prepare(load_->frame, workers_);
    return;
  }
  builder_.record(recorder_.begin(), *structure_, nullptr);
  timeline_.wait(recorder_.submit(timeline_));
}

void ViewloomContestant::sweep(const TraceOutputs& outputs) {
  sweepAtlas({.job = &load_->job,
              .plan = &sweep_->plan,
              .source = sweep_->source.rowSource(),
              .inv_z_max = float(sweep_->source.measured().stats.inv_z_max)},
             outputs, workers_, sweep_->sweepers, sweep_->atlas);
}

void ViewloomContestant::trace() {
  if (sweep_) return sweep({});
  const Commands commands = recorder_.begin();
  for (uint32_t band = 0; band < bands_.size(); ++band) {
    tracer_.recordBand(commands, *structure_, load_->job,
                       rowsOfBand(band, load_->job.layout->size_px.height), *bands_[band], nullptr);
  }
  timeline_.wait(recorder_.submit(timeline_));
}

Picture ViewloomContestant::picture() {
  Picture picture;
  if (sweep_) {
    sweep({.records = true});
    picture.rgba.assign(sweep_->atlas.color.begin(), sweep_->atlas.color.end());
    for (const abi::RayRecord& record : sweep_->atlas.records) {
      const bool is_hit =
          record.ray_class == abi::kClassHit || record.ray_class == abi::kClassHitAssumed;
      picture.inv_z.push_back(is_hit ? record.inv_z : kNoSurface);
    }
    return picture;
  }
  traceBands({.records = true}, [&](const TraceSlot& band, BandRows rows) {
    const size_t count = size_t{rows.row_count} * load_->job.layout->size_px.width;
    const auto colors = band.color().first(count);
    picture.rgba.insert(picture.rgba.end(), colors.begin(), colors.end());
    for (const abi::RayRecord& record : band.records().first(count)) {
      const bool is_hit =
          record.ray_class == abi::kClassHit || record.ray_class == abi::kClassHitAssumed;
      picture.inv_z.push_back(is_hit ? record.inv_z : kNoSurface);
    }
  });
  return picture;
}

Visits ViewloomContestant::visits() {
  VisitCounter counter(*load_->job.layout);
  traceBands({.records = true}, [&](const TraceSlot& band, BandRows rows) {
    counter.addRows(
        band.records().first(size_t{rows.row_count} * load_->job.layout->size_px.width));
  });
  return counter.visits();
}

void ViewloomContestant::traceBands(
    const TraceOutputs& outputs,
    const std::function<void(const TraceSlot& band, BandRows rows)>& on_band) {
  // Few rows at a time: a record is six times a colour.
  constexpr uint32_t kRowCount = 128;
  const SizePx atlas_px = load_->job.layout->size_px;
  TraceSlot slot(device_, {.width_px = atlas_px.width,
                           .row_count_max = kRowCount,
                           .tile_count_max = uint32_t(load_->job.tiles.size()),
                           .outputs = outputs});
  for (uint32_t row = 0; row < atlas_px.height; row += kRowCount) {
    const BandRows rows{row, std::min(kRowCount, atlas_px.height - row)};
    tracer_.recordBand(recorder_.begin(), *structure_, load_->job, rows, slot, nullptr);
    timeline_.wait(recorder_.submit(timeline_));
    on_band(slot, rows);
  }
}

}  // namespace viewloom::bench
