// SPDX-License-Identifier: Apache-2.0
#include "pipeline/stream_retimer.h"

#include <optional>
#include <utility>

#include "admission/frame_price.h"
#include "base/log.h"
#include "pipeline/build_charge.h"
#include "pipeline/frame_px.h"
#include "schedule/retime_schedule.h"

namespace viewloom {
namespace {

// False while there is no room.
bool carryStructures(AtlasJob& job, const RetimeOrder& order) {
  using enum StreamRetimer::Which;
  const RetimeDates dates = retimeDatesOf(job);
  const Guesses guesses = job.before ? Guesses::kGiveWay : Guesses::kStand;
  if (dates.before_ns) {
    ResidentPtr before =
        job.before->retimer->carried(job.before, *dates.before_ns, kBefore, guesses, order);
    if (!before) return false;
    job.before = std::move(before);
  }
  ResidentPtr newest =
      job.structure->retimer->carried(job.structure, dates.newest_ns, kNewest, guesses, order);
  if (!newest) return false;
  job.structure = std::move(newest);
  return true;
}

}  // namespace

StreamRetimer::StreamRetimer(const PipelineLinks& links, const FrameBuilder& builder)
    : links_(links),
      builder_(builder),
      preparers_(links.engines),
      carried_{Carried{.retimer = FrameRetimer(builder.workers()), .structure = nullptr},
               Carried{.retimer = FrameRetimer(builder.workers()), .structure = nullptr}} {
  links_.memory.addIdle(slots_.idleMemory());
}

ResidentPtr StreamRetimer::carried(const ResidentPtr& structure, int64_t carried_ns, Which which,
                                   Guesses guesses, const RetimeOrder& order) {
  if (carried_ns == 0) return structure;
  Carried& last = carried_[size_t(which)];
  const bool is_known = last.structure && last.serial == structure->serial &&
                        last.carried_ns == carried_ns && last.guesses == guesses;
  if (is_known) return last.structure;
  last.structure = nullptr;  // its slot may serve again
  if (!makeRoom(*structure->moving_frame, last)) return structure;
  try {
    last.structure = build(*structure, carried_ns, guesses, last.retimer, order);
  } catch (const EngineOutOfMemory& error) {
    log(LogLevel::kWarning, "stream ", structure->stream,
        ": shown without pictures between its frames: ", error.what());
    return structure;
  }
  last.serial = structure->serial;
  last.carried_ns = carried_ns;
  last.guesses = guesses;
  return last.structure;
}

bool StreamRetimer::makeRoom(const Frame& frame, Carried& carried) const {
  // Planes that are read and made, and the surfaces between them: four times the frame, about.
  constexpr uint64_t kCopies = 4;
  const uint64_t bytes = kCopies * framePrice(frame.format).decoded_bytes;
  if (carried.memory.bytes() == bytes) return true;
  carried.memory.release();
  std::optional<Reservation> reserved = links_.memory.tryReserve(
      {.use = MemoryUse::kStructures, .identity = frame.publisher, .bytes = bytes});
  if (!reserved) return false;
  carried.memory = *std::move(reserved);
  return true;
}

ResidentPtr StreamRetimer::build(const ResidentStructure& structure, int64_t carried_ns,
                                 Guesses guesses, FrameRetimer& retimer, const RetimeOrder& order) {
  const uint64_t px_count = pxOf(*structure.moving_frame);
  BuildCharge charge(order.shares, links_.metrics, order.claim, px_cost_.predictNs(px_count));
  const int64_t started_ns = links_.clock.nowNs();
  const FramePtr frame =
      retimer.retime(structure.moving_frame, 1e-9 * double(carried_ns), guesses, [&order] {
        if (order.is_given_up()) throw PreparationGivenUp();
      });
  const int64_t retimed_ns = links_.clock.nowNs();
  std::shared_ptr<FrameForms> slot = builder_.takeSlot(slots_, preparers_, frame);
  if (!slot) return nullptr;
  auto carried = std::make_shared<ResidentStructure>(structure);
  carried->moving_frame = nullptr;
  carried->retimer = nullptr;
  builder_.build(*frame, std::move(slot), charge.events(order.is_given_up), *carried);
  px_cost_.note(px_count, charge.settle());
  carried->retime_ns = retimed_ns - started_ns;
  // Bad samples were counted when the frame came.
  carried->stats.bad_samples_count = structure.stats.bad_samples_count;
  carried->stats.unsorted_columns_count = structure.stats.unsorted_columns_count;
  carried->stats.bad_normals_count = structure.stats.bad_normals_count;
  carried->stats.bad_motions_count = structure.stats.bad_motions_count;
  links_.metrics.structures_built.add();
  links_.metrics.structures_retimed.add();
  links_.metrics.observeStage(Stage::kRetime, carried->retime_ns);
  links_.metrics.observeStage(Stage::kUpload, carried->upload_ns);
  links_.metrics.observeStage(Stage::kBuild, carried->build_ns);
  return carried;
}

bool showAsOfTick(AtlasJob& job, FairShares& shares, const std::stop_token& stop) {
  const RetimeOrder order{.shares = shares, .claim = claimOf(job), .is_given_up = [&stop] {
                            return stop.stop_requested();
                          }};
  try {
    return carryStructures(job, order);
  } catch (const PreparationGivenUp&) {
    return false;
  }
}

}  // namespace viewloom
