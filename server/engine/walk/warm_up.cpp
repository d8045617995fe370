// SPDX-License-Identifier: Apache-2.0
#include "walk/warm_up.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/check.h"
#include "base/log.h"
#include "base/thread_time.h"
#include "lens/band_gatherer.h"
#include "lens/host_structure.h"
#include "picture/trace_job.h"

namespace viewloom {
namespace {

constexpr SizePx kSource_px{64, 48};
// Views of stereo displays are about as large as their source, those of quilts are smaller: then
// colour is averaged, by two samples to each side where they are a fourth as wide
// (trace/mean_color_pass.h).
constexpr SizePx kEye_px = kSource_px;
constexpr SizePx kTile_px{kSource_px.width / 4, kSource_px.height / 4};
// Those of pages that look around are between both, and less while the eye moves: one sample to
// each side.
constexpr SizePx kSmallEye_px{kSource_px.width / 2, kSource_px.height / 2};
// Enough columns for the kernels of quilts (trace/px_runs.cpp).
constexpr uint32_t kColumns = 8;

using DisplayKind = decltype(DisplaySpec::kind);

// A wall at 2 m with a square 1 m before it; further layers lie behind it.
FramePtr smallFrame(uint32_t layer_count) {
  const auto frame = std::make_shared<Frame>();
  frame->format.number = 1;
  SourceFormat source;
  source.camera.intrinsics = {.focal_px = glm::dvec2(kSource_px.width),
                              .principal_px = {kSource_px.width / 2, kSource_px.height / 2}};
  std::vector<LayerPlanes> planes;
  const auto color = std::make_shared<std::vector<uint8_t>>(kSource_px.area() * 4, uint8_t{128});
  for (uint32_t layer = 0; layer < layer_count; ++layer) {
    std::vector<float> depth_m;
    for (uint32_t y = 0; y < kSource_px.height; ++y) {
      for (uint32_t x = 0; x < kSource_px.width; ++x) {
        const bool is_square = layer == 0 && x / 16 == 1 && y / 16 == 1;
        depth_m.push_back(is_square ? 1.0F : 2.0F + float(layer));
      }
    }
    const auto depth = std::make_shared<std::vector<uint8_t>>(depth_m.size() * sizeof(float));
    std::memcpy(depth->data(), depth_m.data(), depth->size());
    source.layers.push_back({.color = {.kind = PlaneKind::kColor, .size_px = kSource_px},
                             .depth = {.kind = PlaneKind::kDepth,
                                       .encoding = PlaneEncoding::kDepthF32,
                                       .size_px = kSource_px}});
    planes.push_back({.color = color, .depth = depth});
  }
  frame->format.sources.push_back(std::move(source));
  frame->sources.push_back(std::move(planes));
  return frame;
}

QuiltSpec quiltOf(SizePx tile_px) {
  return {.columns = kColumns, .rows = 1, .size_px = {kColumns * tile_px.width, tile_px.height}};
}

}  // namespace

WarmUp::WarmUp(StructureWorks& works, ViewTracer& tracer)
    : works_(works),
      tracer_(tracer),
      recorder_(works.device),
      left_(likelyPictures()),
      frames_{smallFrame(1), smallFrame(2)} {
  sources_.push_back(seenSource(frames_.front()->format.sources.front()));
}

// The likeliest comes last.
std::vector<WarmUp::SmallPicture> WarmUp::likelyPictures() {
  // Away from the source's rows: eyes that move, displays in the world.
  const Pose beside{.position_m = {0.02, 0.03, 0.05}};
  const StereoSpec eyes{.eye_size_px = kEye_px};
  const StereoSpec small_eyes{.eye_size_px = kSmallEye_px};
  const QuiltSpec quilt = quiltOf(kTile_px);
  const LensSpec lens{.aperture_radius_m = 0.03};
  LensSpec exact = lens;
  exact.is_exact = true;
  std::vector<SmallPicture> pictures;
  const auto add = [&](DisplaySpec spec, const TraceOutputs& planes = {}) {
    absl::StatusOr<DisplaySpec> complete = completeDisplaySpec(spec);
    VIEWLOOM_CHECK(complete.ok());
    pictures.push_back({*std::move(complete), planes});
  };
  add({.kind = eyes, .world_pose = beside, .lens = exact});
  add({.kind = quilt, .lens = exact});
  add({.kind = IntegralSpec{.panel_px = {64, 48},
                            .pixel_pitch_m = 1e-4,
                            .lens_pitch_m = 1e-3,
                            .focal_length_m = 3e-3}});
  add({.kind = quiltOf(kSource_px)});
  add({.kind = quiltOf(kSource_px), .world_pose = beside});
  for (const DisplayKind& kind : {DisplayKind(eyes), DisplayKind(quilt)}) {
    add({.kind = kind, .world_pose = beside, .lens = lens});
    add({.kind = kind, .lens = lens});
  }
  for (const TraceOutputs& planes : {TraceOutputs{.depth = true, .mask = true}, TraceOutputs{}}) {
    for (const DisplayKind& kind : {DisplayKind(eyes), DisplayKind(quilt)}) {
      add({.kind = kind}, planes);
      add({.kind = kind, .world_pose = beside}, planes);
    }
  }
  // Pages reproject the picture of an eye by its depth, where they can.
  const TraceOutputs depth{.depth = true};
  add({.kind = eyes, .world_pose = beside}, depth);
  add({.kind = small_eyes, .world_pose = beside}, depth);
  add({.kind = small_eyes, .world_pose = beside});
  return pictures;
}

bool WarmUp::makeNext(const std::stop_token& stop) {
  if (!frames_.empty()) {
    build();
    return true;
  }
  if (left_.empty()) return false;
  if (!current_) {
    begin(left_.back());
    if (!compile(stop)) return false;
  }
  traceNext();
  if (current_) return true;
  left_.pop_back();
  if (left_.empty()) tellEnd();
  return true;
}

void WarmUp::tellEnd() const {
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begun_;
  log(LogLevel::kInfo, "kernels of likely displays are compiled, ", passed.count(),
      " s after the start");
}

void WarmUp::build() {
  const FramePtr frame = std::move(frames_.back());
  frames_.pop_back();
  structure_ = std::make_unique<FrameStructure>(works_.device, shapesOf(*frame));
  structure_->upload(*frame);
  structure_->recordBuild(recorder_.begin(), works_.builder);
  submit();
}

WarmUp::TracedPicture::TracedPicture(const Device& device, const FrameStructure& structure,
                                     TraceJob traced, const TraceOutputs& wanted)
    : job(std::move(traced)),
      planes(wanted),
      rows{0, std::min(job.layout->size_px.height, kBandRowsMax)},
      slot(device, slotShape(job, rows.row_count, planes)),
      parts(ViewTracer::partsOf(structure.parts(), job, rows)) {}

void WarmUp::begin(const SmallPicture& picture) {
  const SeenSource& source = sources_.front();
  absl::StatusOr<AtlasLayout> layout = makeAtlasLayout(
      picture.spec,
      streamDefaults(source.camera.intrinsics, source.size_px, structure_->stats().front()));
  VIEWLOOM_CHECK(layout.ok());
  TraceJob job = makeTraceJob(std::make_shared<AtlasLayout>(*std::move(layout)), picture.spec,
                              displayPose(picture.spec, source.camera), sources_);
  job.gathers_on_host =
      gathersOnHost(isInReach(works_.device, structure_->firstPart().shape()), job);
  TraceOutputs planes = picture.planes;
  planes.color = tracer_.colorForm(ColorForm::kYcbcr420);
  current_.emplace(works_.device, *structure_, std::move(job), planes);
}

// A software device compiles a kernel once more when it comes to its first dispatch, so there it is
// left to the recording of that: whoever measures knows by Device::kernelCount() when that was.
bool WarmUp::compile(const std::stop_token& stop) {
  if (works_.device.info().is_software) return !stop.stop_requested();
  for (const auto& [place, compile] :
       tracer_.missing(structure_->parts(), current_->job, current_->planes)) {
    if (stop.stop_requested()) return false;
    compile();
  }
  return true;
}

// The means of colour that the picture takes, or the next part of it.
void WarmUp::traceNext() {
  const Commands commands = recorder_.begin();
  const uint64_t all_texels = kSource_px.area();
  if (tracer_.recordMeans(commands, structure_->parts(), current_->job, current_->planes,
                          all_texels) > 0) {
    submit();
    return;
  }
  // Kernels of further samples are others.
  const uint64_t rays_of_sample =
      uint64_t{current_->rows.row_count} * current_->job.layout->size_px.width;
  const BandPart part = current_->parts.take(rays_of_sample);
  tracer_.recordPart(commands, structure_->parts(), current_->job, current_->rows, part,
                     current_->slot);
  submit();
  if (current_->parts.isOver()) current_.reset();
}

// Others that submit meanwhile do not take its time for theirs.
void WarmUp::submit() {
  const int64_t submitted_ns = wallTimeNs();
  works_.timeline.wait(recorder_.submit(works_.timeline));
  works_.clock.noteDone(submitted_ns);
}

}  // namespace viewloom
