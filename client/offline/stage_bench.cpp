// SPDX-License-Identifier: Apache-2.0
#include "offline/stage_bench.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/byte_pool.h"
#include "base/check.h"
#include "base/clock.h"
#include "display/atlas_layout.h"
#include "encode/band_encoder.h"
#include "gpu/commands.h"
#include "gpu/gpu_timer.h"
#include "gpu/submission.h"
#include "offline/effective_nodes.h"
#include "offline/median.h"
#include "structure/structure_builder.h"
#include "sweep/sweep_source.h"
#include "sweep/view_sweeper.h"
#include "trace/view_tracer.h"

namespace viewloom {
namespace {

// Nodes of all levels above the facets.
uint64_t nodeCount(const StructureLayout& layout) {
  uint64_t count = 0;
  for (uint32_t level = abi::kLevelFirst; level <= abi::kLevelLast; ++level) {
    count += layout.levelSize(level).area();
  }
  return count;
}

double perPixel(uint64_t count, const StructureLayout& layout) {
  return static_cast<double>(count) / static_cast<double>(layout.size_px.area());
}

// Everything one repetition needs, kept from one to the next.
class StageBench {
 public:
  StageBench(const Device& device, const FramePtr& frame, const DisplaySpec& spec,
             const EncodingSpec& encoding)
      : frame_(frame),
        spec_(spec),
        encoding_(encoding),
        timeline_(device),
        recorder_(device),
        structure_(device, shapeOf(*frame)),
        builder_(device),
        tracer_(device),
        build_timer_(device, kStructurePassCountMax),
        trace_timer_(device, 1),
        encoder_(pool_) {
    build();  // what the layout needs to know of the content
    effective_node_count_ = effectiveNodeCount(nearestCells(device), structure_.layout());
    const Camera& camera = structure_.sourceCamera();
    const SizePx source_px = structure_.layout().size_px;
    const auto layout =
        makeAtlasLayout(spec, {.source_intrinsics = camera.intrinsics,
                               .source_size_px = source_px,
                               .focal_distance_m = contentFocalDistance(structure_.stats())});
    VIEWLOOM_CHECK(layout.ok());
    layout_ = std::make_shared<AtlasLayout>(*layout);
    job_ = makeTraceJob(layout_, spec_, displayPose(spec_, camera), camera, source_px);
    if (device.info().is_software && canSweep(*frame)) {
      plan_ = SweepPlan::make(job_, structure_.stats().inv_z_max);
    }
    trace_slot_ = std::make_unique<TraceSlot>(
        device, slotShape(job_, bandRowCount(encoding_),
                          {.color = tracer_.colorForm(directForm(encoding_))}));
  }

  void repeat() {
    encoded_bytes_ = 0;
    if (plan_) {
      samples_["sweep source"].push_back(timed([&] { sweep_source_.prepare(frame_, workers_); }));
      samples_["sweep"].push_back(timed([&] { sweep(); }));
      samples_["encode"].push_back(timed([&] { encodeSwept(); }));
    }
    samples_["upload"].push_back(timed([&] { structure_.upload(*frame_); }));
    samples_["build"].push_back(timed([&] { build(); }));
    for (const GpuPassTime& pass : build_timer_.results()) {
      build_passes_[pass.name].push_back(static_cast<double>(pass.duration_ns) * 1e-6);
    }
    double trace_ms = 0;
    double submit_ms = 0;
    double encode_ms = 0;
    ray_count_ = 0;
    for (uint32_t row = 0; row < layout_->size_px.height; row += bandRowCount(encoding_)) {
      const BandRows rows = {row, std::min(bandRowCount(encoding_), layout_->size_px.height - row)};
      const double band_ms = timed([&] { trace(rows); });
      const std::span<const GpuPassTime> passes = trace_timer_.results();
      trace_ms += passes.empty() ? band_ms : static_cast<double>(passes[0].duration_ns) * 1e-6;
      submit_ms += band_ms;
      if (!plan_) encode_ms += timed([&] { encodeTraced(rows); });
      ray_count_ += trace_slot_->coverage().rayCount();
    }
    samples_["trace"].push_back(trace_ms);
    samples_["readback"].push_back(submit_ms - trace_ms);
    if (!plan_) samples_["encode"].push_back(encode_ms);
  }

  void forgetSamples() {
    samples_.clear();
    build_passes_.clear();
  }

  StageReport report() const {
    const StructureLayout& layout = structure_.layout();
    StageReport report = {.source_px = layout.size_px.area() * structure_.shape().layerCount(),
                          .ray_count = ray_count_,
                          .disparity_span_px = disparitySpanPx(job_, structure_.stats().inv_z_max),
                          .upload_ms = medianOf(samples_.at("upload")),
                          .build_ms = medianOf(samples_.at("build")),
                          .build_pass_ms = {},
                          .trace_ms = medianOf(samples_.at("trace")),
                          .readback_ms = medianOf(samples_.at("readback")),
                          .encode_ms = medianOf(samples_.at("encode")),
                          .encoded_bytes = encoded_bytes_,
                          .stored_nodes_per_px = perPixel(nodeCount(layout), layout),
                          .effective_nodes_per_px = perPixel(effective_node_count_, layout),
                          .structure_bytes_per_px = perPixel(layout.layerBytes(), layout),
                          .structure_bytes = structureBytes(structure_.shape()),
                          .build_bytes = buildBytes(structure_.shape()),
                          .trace_slot_bytes = trace_slot_->sizeBytes()};
    if (plan_) {
      report.sweep_source_ms = medianOf(samples_.at("sweep source"));
      report.sweep_ms = medianOf(samples_.at("sweep"));
      report.swept_frame_bytes = structure_.shape().staged_bytes + sweep_source_.sizeBytes();
      report.swept_atlas_bytes =
          swept_atlas_.color.size() * sizeof(uint32_t) + swept_atlas_.ycbcr.size();
    }
    for (const auto& [name, values] : build_passes_) report.build_pass_ms[name] = medianOf(values);
    return report;
  }

 private:
  template <typename Work>
  double timed(Work work) const {
    const int64_t started_ns = clock_.nowNs();
    work();
    return static_cast<double>(clock_.nowNs() - started_ns) * 1e-6;
  }

  void build() {
    if (!is_uploaded_) structure_.upload(*frame_);
    is_uploaded_ = true;
    const Commands commands = recorder_.begin();
    build_timer_.recordReset(commands);
    builder_.record(commands, structure_, &build_timer_);
    timeline_.wait(recorder_.submit(timeline_));
  }

  std::vector<abi::uvec2> nearestCells(const Device& device) {
    const uint64_t size_bytes = structure_.layout().cellCount() * sizeof(abi::uvec2);
    const Buffer readback(device, {.size_bytes = size_bytes,
                                   .intent = MemoryIntent::kReadback,
                                   .debug_name = "bench readback"});
    const LayeredBuffer& arrays = structure_.structure();
    const Commands commands = recorder_.begin();
    commands.copy(arrays.buffer(0), readback,
                  {.from_offset = arrays.offsetBytes(0), .size_bytes = size_bytes});
    recordTransferToHost(commands);
    timeline_.wait(recorder_.submit(timeline_));
    std::vector<abi::uvec2> cells(structure_.layout().cellCount());
    std::memcpy(cells.data(), readback.mapped().data(), size_bytes);
    return cells;
  }

  void sweep() {
    sweepAtlas({.job = &job_,
                .plan = &*plan_,
                .source = sweep_source_.rowSource(),
                .inv_z_max = static_cast<float>(sweep_source_.measured().stats.inv_z_max)},
               {.color = sweptForm()}, workers_, sweepers_, swept_atlas_);
  }

  void trace(BandRows rows) {
    const Commands commands = recorder_.begin();
    trace_timer_.recordReset(commands);
    tracer_.recordBand(commands, structure_, job_, rows, *trace_slot_, &trace_timer_);
    timeline_.wait(recorder_.submit(timeline_));
  }

  ColorForm sweptForm() const { return plan_->colorForm(directForm(encoding_)); }

  void encodeSwept() {
    const BandPixels atlas =
        colorPixels(swept_atlas_.color, swept_atlas_.ycbcr, layout_->size_px, sweptForm());
    for (uint32_t row = 0; row < atlas.row_count; row += bandRowCount(encoding_)) {
      encode(rowsOf(atlas, row, bandRowCount(encoding_)));
    }
  }

  void encodeTraced(BandRows rows) {
    BandPixels band =
        colorPixels(trace_slot_->color(), trace_slot_->ycbcr(),
                    {layout_->size_px.width, rows.row_count}, trace_slot_->shape().outputs.color);
    band.first_row = rows.first_row;
    encode(band);
  }

  void encode(const BandPixels& pixels) {
    encoded_bytes_ += encoder_.encode(pixels, encoding_, *layout_).bytes->size();
  }

  const FramePtr frame_;
  const DisplaySpec& spec_;
  const EncodingSpec encoding_;
  const SteadyClock clock_;
  Timeline timeline_;
  CommandRecorder recorder_;
  StructureSlot structure_;
  bool is_uploaded_ = false;
  StructureBuilder builder_;
  ViewTracer tracer_;
  GpuTimer build_timer_;
  GpuTimer trace_timer_;
  BytePool pool_{4};
  BandEncoder encoder_;
  std::shared_ptr<const AtlasLayout> layout_;
  TraceJob job_;
  std::unique_ptr<TraceSlot> trace_slot_;
  WorkerPool workers_;
  std::optional<SweepPlan> plan_;  // of what the server would sweep
  SweepSource sweep_source_;
  std::vector<ViewSweeper> sweepers_;
  SweptAtlas swept_atlas_;

  uint64_t effective_node_count_ = 0;                        // of the nearest layer
  uint64_t ray_count_ = 0;                                   // of the last repetition
  uint64_t encoded_bytes_ = 0;                               // of the last repetition
  std::map<std::string, std::vector<double>> samples_;       // ms
  std::map<std::string, std::vector<double>> build_passes_;  // ms
};

}  // namespace

double disparitySpanPx(const TraceJob& job, double inv_z_max) {
  double moved_px_m = 0;
  for (const abi::ViewParams& tile : job.tiles) {
    moved_px_m = std::max(moved_px_m, std::hypot(double{tile.eye.x}, double{tile.eye.y}));
  }
  return moved_px_m * inv_z_max;
}

StageReport measureStages(const Device& device, const FramePtr& frame, const DisplaySpec& spec,
                          const EncodingSpec& encoding, uint32_t repetition_count) {
  StageBench bench(device, frame, spec, encoding);
  bench.repeat();
  bench.forgetSamples();
  for (uint32_t i = 0; i < repetition_count; ++i) bench.repeat();
  return bench.report();
}

}  // namespace viewloom
