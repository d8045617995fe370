// SPDX-License-Identifier: Apache-2.0
#include "walk/offline_renderer.h"

#include <algorithm>
#include <limits>

#include "base/check.h"
#include "picture/display_sources.h"

namespace viewloom {
namespace {

// Rows traced at once: large enough to keep the device busy, small beside an atlas.
constexpr uint32_t kBandRows = 128;

// Adds the band's rows to the planes of the atlas that were asked for.
void append(const TraceSlot& slot, const TraceOutputs& outputs, RenderedAtlas& atlas) {
  const auto add = [](const auto& from, auto& to) {
    to.insert(to.end(), from.begin(), from.end());
  };
  add(slot.color(), atlas.color);
  if (outputs.linear) add(slot.linear(), atlas.linear);
  if (outputs.mask) add(slot.mask(), atlas.mask);
  if (outputs.records) {
    for (const abi::RayRecord& record : slot.records()) atlas.visits.push_back(record.visits);
  }
  atlas.coverage.add(slot.coverage());
  atlas.reflections.add(slot.reflections());
}

void reserve(const TraceOutputs& outputs, RenderedAtlas& atlas) {
  const uint64_t area_px = atlas.layout->size_px.area();
  atlas.color.reserve(area_px);
  if (outputs.linear) atlas.linear.reserve(4 * area_px);
  if (outputs.mask) atlas.mask.reserve(area_px);
  if (outputs.records) atlas.visits.reserve(area_px);
}

}  // namespace

OfflineRenderer::OfflineRenderer(const Device& device, GatheringPlace gathering_place)
    : device_(device),
      gathering_place_(gathering_place),
      timeline_(device),
      recorder_(device),
      builder_(device),
      tracer_(device),
      gatherers_(workers_.workerCount()) {}

void OfflineRenderer::build(const Frame& frame, const std::optional<Pose>& camera_pose) {
  focal_stats_.reset();
  if (camera_pose && structure_) focal_stats_ = structure_->stats().front();
  structure_.reset();
  structure_.emplace(device_, shapesOf(frame));
  structure_->upload(frame);
  sources_.clear();
  for (const SourceFormat& source : frame.format.sources) sources_.push_back(seenSource(source));
  shown_camera_ = sources_.front().camera;
  shown_camera_.pose = camera_pose.value_or(shown_camera_.pose);
  structure_->recordBuild(recorder_.begin(), builder_);
  timeline_.wait(recorder_.submit(timeline_));
}

std::vector<SourceStats> OfflineRenderer::stats() const {
  return structure_->stats();
}

void OfflineRenderer::traceBand(const TraceJob& job, BandRows rows, TraceSlot& slot) {
  tracer_.recordBand(recorder_.begin(), structure_->parts(), job, rows, slot, nullptr);
  timeline_.wait(recorder_.submit(timeline_));
  if (job.gathers_on_host) gatherLens(job, rows, slot);
}

void OfflineRenderer::gatherLens(const TraceJob& job, BandRows rows, TraceSlot& slot) {
  const HostStructure structure = hostStructure(structure_->firstPart());
  const std::vector<GatheredPiece> pieces =
      gatheredPieces(*job.layout, rows, std::numeric_limits<uint64_t>::max());
  const uint32_t first_row = pieces.front().rows.first_row;
  workers_.forEach(uint32_t(pieces.size()), [&](uint32_t index, uint32_t worker) {
    const GatheredPiece& piece = pieces[index];
    gatherers_[worker].gather(structure, job,
                              bandOf(slot, *job.layout, piece, piece.rows.first_row - first_row));
  });
}

absl::StatusOr<RenderedAtlas> OfflineRenderer::render(
    const DisplaySpec& spec, const TraceOutputs& outputs,
    const std::function<void(uint32_t done_rows, uint32_t row_count)>& on_progress) {
  VIEWLOOM_CHECK(structure_.has_value());
  VIEWLOOM_RETURN_IF_ERROR(validateAtlasLimits(spec, AtlasLimits{}));
  const Camera& source_camera = sources_.front().camera;
  VIEWLOOM_RETURN_IF_ERROR(validateSourcesOf(spec, sources_));
  absl::StatusOr<AtlasLayout> layout =
      makeAtlasLayout(spec, streamDefaults(source_camera.intrinsics, sources_.front().size_px,
                                           focal_stats_.value_or(structure_->stats().front())));
  if (!layout.ok()) return layout.status();

  RenderedAtlas atlas;
  atlas.layout = std::make_shared<AtlasLayout>(*std::move(layout));
  reserve(outputs, atlas);
  TraceJob job = makeTraceJob(atlas.layout, spec, displayPose(spec, shown_camera_), sources_);
  if (gathering_place_ == GatheringPlace::kHost) {
    job.gathers_on_host = gathersOnHost(isInReach(device_, structure_->firstPart().shape()), job);
  }
  const SizePx size_px = atlas.layout->size_px;
  TraceSlot slot(device_, slotShape(job, std::min(kBandRows, size_px.height), outputs));
  for (uint32_t row = 0; row < size_px.height; row += kBandRows) {
    const uint32_t row_count = std::min(kBandRows, size_px.height - row);
    traceBand(job, {.first_row = row, .row_count = row_count}, slot);
    append(slot, outputs, atlas);
    on_progress(row + row_count, size_px.height);
  }
  return atlas;
}

}  // namespace viewloom
