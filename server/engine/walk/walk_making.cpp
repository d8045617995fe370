// SPDX-License-Identifier: Apache-2.0
#include "walk/walk_making.h"

#include <algorithm>
#include <utility>

#include "lens/host_structure.h"
#include "trace/band_parts.h"
#include "walk/within_device_memory.h"

namespace viewloom {
namespace {

const WalkedFrame& walked(const PreparedFrame& frame) {
  return static_cast<const WalkedFrame&>(frame);
}

const PicturePtr& tracedPicture(const AtlasOrder& order) {
  return static_cast<const WalkPlan&>(*order.plan).picture;
}

std::vector<const StructureSlot*> structuresOf(const AtlasOrder& order) {
  std::vector<const StructureSlot*> structures;
  for (const PreparedFrame* frame : order.frames) {
    const auto parts = walked(*frame).structure().parts();
    structures.insert(structures.end(), parts.begin(), parts.end());
  }
  return structures;
}

bool isInReach(const Device& device, const WalkedFrame& frame) {
  return isInReach(device, frame.shapes().front());
}

PicturePtr settled(bool is_in_reach, const PicturePtr& whole) {
  if (!gathersOnHost(is_in_reach, *whole)) return whole;
  auto picture = std::make_shared<TraceJob>(*whole);
  picture->gathers_on_host = true;
  return picture;
}

uint64_t gatheredRays(const TraceJob& picture, uint64_t row_count) {
  return row_count * picture.layout->size_px.width * picture.layout->lens->pointCount();
}

// Pieces of the strip whose lens threads gather.
std::vector<GatheredPiece> gatheredPieces(const TraceJob& picture, BandRows rows,
                                          uint64_t ray_count) {
  if (!picture.gathers_on_host) return {};
  return gatheredPieces(*picture.layout, rows, ray_count);
}

// A strip that the device is done with.
class WalkedStrip final : public StripWork {
 public:
  WalkedStrip(PicturePtr picture, uint32_t strip, BandRows rows, const StructureSlot& structure,
              std::shared_ptr<StripTrace> trace, std::shared_ptr<GathererShelf> gatherers,
              const std::shared_ptr<WalkCosts>& costs)
      : WalkedStrip(gatheredPieces(*picture, rows, costs->on_host.unitsFor(kPiece_ns)), picture,
                    strip, rows, structure, std::move(trace), std::move(gatherers), costs) {}

  void makePiece(uint32_t index) override {
    const GatheredPiece& piece = pieces_[index];
    std::unique_ptr<BandGatherer> gatherer = gatherers_->take();
    gatherer->gather(
        hostStructure(structure_), *picture_,
        bandOf(trace_->slot, *picture_->layout, piece, piece.rows.first_row - rows_.first_row));
    gatherers_->putBack(std::move(gatherer));
  }

  void notePiece(int64_t measured_ns) override {
    costs_->noteHost(gatheredRays(*picture_, rows_.row_count) / pieces_.size(), measured_ns);
  }

  RayCounts counts() const override {
    return {.coverage = trace_->slot.coverage(), .reflections = trace_->slot.reflections()};
  }

  StripPlanes planes(uint32_t) const override {
    const TraceSlot& slot = trace_->slot;
    return {.rgba = slot.color(),
            .ycbcr = slot.ycbcr(),
            .color_px = {picture_->layout->size_px.width, rows_.row_count},
            .depth = slot.depth(),
            .mask = slot.mask()};
  }

 private:
  WalkedStrip(std::vector<GatheredPiece> pieces, PicturePtr picture, uint32_t strip, BandRows rows,
              const StructureSlot& structure, std::shared_ptr<StripTrace> trace,
              std::shared_ptr<GathererShelf> gatherers, std::shared_ptr<WalkCosts> costs)
      : StripWork({.first_strip = strip,
                   .piece_count = uint32_t(pieces.size()),
                   .piece_ns = pieces.empty()
                                   ? 0
                                   : costs->on_host.predictNs(
                                         gatheredRays(*picture, rows.row_count) / pieces.size())}),
        pieces_(std::move(pieces)),
        picture_(std::move(picture)),
        rows_(rows),
        structure_(structure),
        trace_(std::move(trace)),
        gatherers_(std::move(gatherers)),
        costs_(std::move(costs)) {}

  const std::vector<GatheredPiece> pieces_;
  const PicturePtr picture_;
  const BandRows rows_;
  const StructureSlot& structure_;
  const std::shared_ptr<StripTrace> trace_;  // holding it keeps it from reuse
  const std::shared_ptr<GathererShelf> gatherers_;
  const std::shared_ptr<WalkCosts> costs_;
};

}  // namespace

void WalkCosts::note(RayKind kind, uint64_t ray_count, int64_t measured_ns) {
  on_device[kind].note(ray_count, measured_ns);
  if (of_all) of_all->note(kind, ray_count, measured_ns);
}

void WalkCosts::noteHost(uint64_t ray_count, int64_t measured_ns) {
  on_host.note(ray_count, measured_ns);
  if (of_all) of_all->noteHost(ray_count, measured_ns);
}

WalkPlan::WalkPlan(const Device& used_device, const PicturePtr& whole, const WalkedFrame& frame,
                   std::shared_ptr<WalkCosts> of_all)
    : device(used_device),
      is_in_reach(isInReach(used_device, frame)),
      picture(settled(is_in_reach, whole)),
      costs(std::make_shared<WalkCosts>(*of_all)) {
  costs->of_all = std::move(of_all);
}

bool WalkPlan::holdsFor(const PreparedFrame& frame) const {
  return isInReach(device, walked(frame)) == is_in_reach;
}

std::unique_ptr<BandGatherer> GathererShelf::take() {
  std::lock_guard lock(mutex_);
  if (free_.empty()) return std::make_unique<BandGatherer>();
  std::unique_ptr<BandGatherer> gatherer = std::move(free_.back());
  free_.pop_back();
  return gatherer;
}

void GathererShelf::putBack(std::unique_ptr<BandGatherer> gatherer) {
  std::lock_guard lock(mutex_);
  free_.push_back(std::move(gatherer));
}

WalkMaking::WalkMaking(WalkTools tools, AtlasOrder order, std::shared_ptr<StripTrace> trace,
                       HandOn hand_on)
    : tools_(std::move(tools)),
      use_(tools_.use),
      order_(std::move(order)),
      picture_(tracedPicture(order_)),
      device_(static_cast<const WalkPlan&>(*order_.plan).device),
      costs_(static_cast<const WalkPlan&>(*order_.plan).costs),
      hand_on_(std::move(hand_on)),
      structures_(structuresOf(order_)),
      trace_(std::move(trace)) {}

MissingKernels WalkMaking::missingKernels(ViewTracer& tracer, const AtlasOrder& order) {
  TraceOutputs planes = order.planes;
  planes.color = tracer.colorForm(planes.color);
  return tracer.missing(structuresOf(order), *tracedPicture(order), planes);
}

TraceSlotShape WalkMaking::stripShape(const AtlasOrder& order) {
  return slotShape(*tracedPicture(order), order.strips.rowCountMax(), order.planes);
}

MakingStep WalkMaking::step() {
  try {
    return withinDeviceMemory([this] { return makePart(); });
  } catch (...) {
    forgetMeans();
    throw;
  }
}

// They may have been recorded and never made, and other pictures would go on with them.
void WalkMaking::forgetMeans() {
  for (const StructureSlot* structure : structures_) structure->meanColor().forget();
}

MakingStep WalkMaking::makePart() {
  if (!trace_) trace_ = tools_.strips.take(stripShape(order_), order_);
  if (!trace_) return {.has_room = false};
  if (!has_means_) {
    const MakingStep step = stepMeans();
    has_means_ = step.predicted_ns == 0;
    if (!has_means_) return step;
  }
  return stepPart();
}

// The first of its atlases makes means for all pictures of the frame with as large px. Another one
// that needs them goes on with them.
MakingStep WalkMaking::stepMeans() {
  CommandRecorder& recorder = nextRecorder();
  const Rays texels = raysOf(RayKind::kMeans);
  const uint64_t texel_count = tools_.tracer.recordMeans(
      recorder.begin(), structures_, *picture_, order_.planes, texels.cost.unitsFor(kPiece_ns));
  if (texel_count == 0) return {};
  return {.predicted_ns = submit(recorder, texels, texel_count)};
}

MakingStep WalkMaking::stepPart() {
  const BandRows rows = order_.strips.rowsOf(strip_);
  if (!parts_) parts_.emplace(ViewTracer::partsOf(structures_, *picture_, rows));
  const Rays rays = raysOf(kindOf(parts_->kind()));
  const BandPart part = parts_->take(std::min(kPartRays, rays.cost.unitsFor(kPiece_ns)));
  CommandRecorder& recorder = nextRecorder();
  tools_.tracer.recordPart(recorder.begin(), structures_, *picture_, rows, part, trace_->slot);
  const uint64_t ray_count = ViewTracer::rayCount(structures_, *picture_, part);
  MakingStep step{.predicted_ns = submit(recorder, rays, ray_count)};
  if (!part.is_last) return step;
  parts_.reset();
  handOn(last_value_);
  step.is_last = ++strip_ == order_.strips.count();
  return step;
}

RayKind WalkMaking::kindOf(PartKind kind) const {
  if (kind == PartKind::kMerge) return RayKind::kAnswers;
  if (kind == PartKind::kReflect) return RayKind::kReflected;
  if (kind == PartKind::kSettle) return RayKind::kSettled;
  if (kind == PartKind::kGather) return RayKind::kGathered;
  if (picture_->walk_count > 1) return RayKind::kMerged;
  return picture_->hasLens() && !picture_->gathers_on_host ? RayKind::kThroughLens
                                                           : RayKind::kWalked;
}

CommandRecorder& WalkMaking::nextRecorder() {
  turn_ = (turn_ + 1) % uint32_t(trace_->recorders.size());
  tools_.timeline.wait(trace_->submitted[turn_]);
  return trace_->recorders[turn_];
}

// The cost that the part was cut by is the one that it is predicted with, whatever was learnt while
// it was recorded. A kernel that the device compiles on the way says nothing about rays.
int64_t WalkMaking::submit(CommandRecorder& recorder, const Rays& rays, uint64_t ray_count) {
  const int64_t predicted_ns = std::max<int64_t>(1, rays.cost.predictNs(ray_count));
  const bool is_learnt = rays.kernel_count == device_.kernelCount();
  last_value_ = recorder.submit(tools_.timeline);
  trace_->submitted[turn_] = last_value_;
  tools_.meter.note(last_value_, [costs = costs_, kind = rays.kind, ray_count, predicted_ns,
                                  is_learnt, note_work = order_.note_work](int64_t measured_ns) {
    if (is_learnt) costs->note(kind, ray_count, measured_ns);
    if (note_work) note_work({.predicted_ns = predicted_ns, .measured_ns = measured_ns});
  });
  return predicted_ns;
}

void WalkMaking::giveUp() {
  tools_.timeline.wait(last_value_);
}

// With its last part the slot goes on to those who finish the strip.
void WalkMaking::handOn(uint64_t timeline_value) {
  auto work = std::make_shared<StripWorkPtr>(std::make_unique<WalkedStrip>(
      picture_, strip_, order_.strips.rowsOf(strip_), *structures_.front(), std::move(trace_),
      tools_.gatherers, costs_));
  tools_.watch.whenDone(timeline_value, [work, hand_on = hand_on_] { hand_on(std::move(*work)); });
}

}  // namespace viewloom
