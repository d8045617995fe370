// SPDX-License-Identifier: Apache-2.0
#include "walk/walk_making.h"

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

// Rows of the strip that threads gather the lens of, piece by piece.
std::vector<BandRows> gatheredPieces(const TraceJob& picture, BandRows rows) {
  std::vector<BandRows> pieces;
  while (picture.gathers_on_host && rows.row_count > 0) {
    pieces.push_back(firstGathered(*picture.layout, rows));
    rows.first_row += pieces.back().row_count;
    rows.row_count -= pieces.back().row_count;
  }
  return pieces;
}

// A strip that the device is done with.
class WalkedStrip final : public StripWork {
 public:
  WalkedStrip(PicturePtr picture, uint32_t strip, BandRows rows, const StructureSlot& structure,
              std::shared_ptr<StripTrace> trace, std::shared_ptr<GathererShelf> gatherers)
      : WalkedStrip(gatheredPieces(*picture, rows), picture, strip, rows, structure,
                    std::move(trace), std::move(gatherers)) {}

  void makePiece(uint32_t index) override {
    const BandRows& piece = pieces_[index];
    std::unique_ptr<BandGatherer> gatherer = gatherers_->take();
    gatherer->gather(
        hostStructure(structure_), *picture_,
        bandOf(trace_->slot, *picture_->layout, piece, piece.first_row - rows_.first_row));
    gatherers_->putBack(std::move(gatherer));
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
  WalkedStrip(std::vector<BandRows> pieces, PicturePtr picture, uint32_t strip, BandRows rows,
              const StructureSlot& structure, std::shared_ptr<StripTrace> trace,
              std::shared_ptr<GathererShelf> gatherers)
      : StripWork({.first_strip = strip, .piece_count = uint32_t(pieces.size())}),
        pieces_(std::move(pieces)),
        picture_(std::move(picture)),
        rows_(rows),
        structure_(structure),
        trace_(std::move(trace)),
        gatherers_(std::move(gatherers)) {}

  const std::vector<BandRows> pieces_;
  const PicturePtr picture_;
  const BandRows rows_;
  const StructureSlot& structure_;
  const std::shared_ptr<StripTrace> trace_;  // holding it keeps it from reuse
  const std::shared_ptr<GathererShelf> gatherers_;
};

}  // namespace

WalkPlan::WalkPlan(const Device& used_device, const PicturePtr& whole, const WalkedFrame& frame)
    : device(used_device),
      is_in_reach(isInReach(used_device, frame)),
      picture(settled(is_in_reach, whole)) {}

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
      order_(std::move(order)),
      picture_(tracedPicture(order_)),
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
  return withinDeviceMemory([this] { return makePart(); });
}

MakingStep WalkMaking::makePart() {
  if (!trace_) trace_ = tools_.strips.take(stripShape(order_), order_.is_for_eyes);
  if (!trace_) return {.has_room = false};
  const BandRows rows = order_.strips.rowsOf(strip_);
  const BandParts parts(*picture_, rows);
  MakingStep step{.ray_count = parts.at(part_).ray_count};
  const size_t turn = part_ % trace_->recorders.size();
  tools_.timeline.wait(trace_->submitted[turn]);
  tools_.tracer.recordPart(trace_->recorders[turn].begin(), structures_, *picture_, rows, part_,
                           trace_->slot);
  const uint64_t value = trace_->recorders[turn].submit(tools_.timeline);
  trace_->submitted[turn] = value;
  if (++part_ < parts.count()) return step;
  part_ = 0;
  handOn(value);
  step.is_last = ++strip_ == order_.strips.count();
  return step;
}

// With its last part the slot goes on to those who finish the strip.
void WalkMaking::handOn(uint64_t timeline_value) {
  auto work = std::make_shared<StripWorkPtr>(
      std::make_unique<WalkedStrip>(picture_, strip_, order_.strips.rowsOf(strip_),
                                    *structures_.front(), std::move(trace_), tools_.gatherers));
  tools_.watch.whenDone(timeline_value, [work, hand_on = hand_on_] { hand_on(std::move(*work)); });
}

}  // namespace viewloom
