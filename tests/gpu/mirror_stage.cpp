// SPDX-License-Identifier: Apache-2.0
#include "gpu/mirror_stage.h"

#include <chrono>
#include <cstring>
#include <stdexcept>
#include <string>

#include "gpu/commands.h"
#include "shared/lens_abi.h"
#include "trace/band_params.h"
#include "trace/reflection_settings.h"

namespace viewloom {
namespace {

TraceJob jobOf(const DisplaySpec& spec, const SeenSource& source, const SourceStats& stats) {
  auto layout =
      makeAtlasLayout(spec, streamDefaults(source.camera.intrinsics, source.size_px, stats));
  if (!layout.ok()) throw std::runtime_error(std::string(layout.status().message()));
  return makeTraceJob(std::make_shared<AtlasLayout>(*std::move(layout)), spec,
                      displayPose(spec, source.camera), std::span(&source, 1));
}

Descriptor uniform(uint32_t binding, const Buffer& buffer) {
  return {.binding = binding,
          .kind = DescriptorKind::kUniform,
          .buffer = &buffer,
          .size_bytes = buffer.sizeBytes()};
}

}  // namespace

MirrorStage::MirrorStage(MirrorKernels& kernels, const Frame& frame, const DisplaySpec& display)
    : kernels_(kernels),
      device_(kernels.device),
      timeline_(device_),
      recorder_(device_),
      structure_(device_, shapesOf(frame)) {
  build(frame);
  job_ = jobOf(display, seenSource(frame.format.sources.front()), structure_.stats().front());
  if (!job_.reflects()) throw std::runtime_error("the frame mirrors nothing, or the display");
  traceOwnRays();
}

void MirrorStage::build(const Frame& frame) {
  structure_.upload(frame);
  structure_.recordBuild(recorder_.begin(), kernels_.builder);
  timeline_.wait(recorder_.submit(timeline_));
}

void MirrorStage::traceOwnRays() {
  TraceJob own = job_;
  own.reflection.reset();
  const uint32_t row_count = layout().size_px.height;
  TraceSlot traced(device_, slotShape(own, row_count, {.linear = true, .records = true}));
  kernels_.tracer.recordBand(recorder_.begin(), structure_.parts(), own, {0, row_count}, traced,
                             nullptr);
  timeline_.wait(recorder_.submit(timeline_));
  without_.assign(traced.linear().begin(), traced.linear().end());
  own_records_.assign(traced.records().begin(), traced.records().end());
  describe();
}

// On the device, where that is asked for.
Buffer MirrorStage::filled(const void* from, uint64_t size_bytes, MemoryIntent intent,
                           const char* name) {
  Buffer upload(device_,
                {.size_bytes = size_bytes, .intent = MemoryIntent::kUpload, .debug_name = name});
  std::memcpy(upload.mapped().data(), from, size_bytes);
  if (intent == MemoryIntent::kUpload) return upload;
  Buffer buffer(device_, {.size_bytes = size_bytes, .intent = intent, .debug_name = name});
  const Commands commands = recorder_.begin();
  commands.copy(upload, buffer, {.size_bytes = size_bytes});
  timeline_.wait(recorder_.submit(timeline_));
  return buffer;
}

void MirrorStage::describe() {
  const StructureSlot& structure = structure_.firstPart();
  const uint64_t area_px = layout().size_px.area();
  records_ = filled(own_records_.data(), own_records_.size() * sizeof(abi::RayRecord),
                    MemoryIntent::kDeviceOnly, "rays' ends");
  const std::vector<uint32_t> zeros(kCounterCount);
  counters_ =
      filled(zeros.data(), zeros.size() * sizeof(uint32_t), MemoryIntent::kDeviceOnly, "counters");
  views_ = filled(job_.tiles.data(), job_.tiles.size() * sizeof(abi::ViewParams),
                  MemoryIntent::kDeviceOnly, "views");
  reflected_ = Buffer(device_, {.size_bytes = area_px * sizeof(abi::ReflectedLight),
                                .debug_name = "reflected light"});
  rgba_ = Buffer(device_, {.size_bytes = area_px * sizeof(uint32_t), .debug_name = "rgba"});
  linear_ = ReadablePlane(device_, without_.size() * sizeof(float), "linear");

  const Intrinsics& intrinsics = structure.sourceCamera().intrinsics;
  abi::TraceExtras extras{};
  extras.records = addressWords(records_.address());
  extras.counters = addressWords(counters_.address());
  extras.color_stride = structure.colorStride();
  extras.focal_px = abi::vec2(intrinsics.focal_px);
  extras.principal_px = abi::vec2(intrinsics.principal_px);
  extras_ = filled(&extras, sizeof extras, MemoryIntent::kDeviceOnly, "extras");
  settings_ = Buffer(device_, {.size_bytes = sizeof(abi::ReflectionSettings),
                               .intent = MemoryIntent::kUpload,
                               .debug_name = "reflection settings"});
  setTolerance(job_.tolerance_px);
  params_ = {wholeBuffer(abi::kBindingViews, views_), uniform(abi::kBindingExtras, extras_),
             uniform(abi::kBindingReflection, settings_),
             wholeBuffer(abi::kBindingLensPoints, views_)};  // of no lens: nothing is read
}

void MirrorStage::setTolerance(double tolerance_px) {
  const StructureSlot& structure = structure_.firstPart();
  job_.tolerance_px = tolerance_px;
  const abi::ReflectionSettings settings = reflectionSettings(structure, job_, 0, 0);
  std::memcpy(settings_.mapped().data(), &settings, sizeof settings);
}

abi::TracePush MirrorStage::push() const {
  const StructureSlot& structure = structure_.firstPart();
  abi::TracePush push{};
  push.source_size_px = packSize(structure.shape().depth_px);
  push.layer_count = structure.shape().layerCount();
  push.atlas_width_px = layout().size_px.width;
  push.tile_size_px = packSize(layout().tile_size_px);
  push.tile_grid = packSize({layout().columns, layout().rows});
  push.padding_top_px = layout().padding_top_px;
  push.row_count = layout().size_px.height;
  for (uint32_t i = 0; i < structure.shape().layerCount(); ++i) {
    push.layers[i] = addressWords(structure.structure().address(i));
    push.color[i] = addressWords(structure.color().address(i));
  }
  return push;
}

double MirrorStage::timedMs(const Record& record) {
  const Commands commands = recorder_.begin();
  record(commands, {.structure = structure_.firstPart(),
                    .job = job_,
                    .row_count = layout().size_px.height,
                    .columns = {0, groupCount(layout().size_px.width)},
                    .push = push(),
                    .params = params_,
                    .reflected = reflected_});
  const auto begun = std::chrono::steady_clock::now();
  timeline_.wait(recorder_.submit(timeline_));
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun)
      .count();
}

std::vector<float> MirrorStage::picture() {
  const uint64_t size_bytes = without_.size() * sizeof(float);
  const Buffer before =
      filled(without_.data(), size_bytes, MemoryIntent::kUpload, "without its mirrors");
  const Commands commands = recorder_.begin();
  commands.copy(before, linear_.target(), {.size_bytes = size_bytes});
  recordTransferToCompute(commands);
  kernels_.mirrored_light.record(commands, job_,
                                 {.rows = {0, layout().size_px.height},
                                  .reflected = reflected_,
                                  .rgba = rgba_,
                                  .linear_address = linear_.target().address(),
                                  .span = {0, layout().size_px.height}});
  recordComputeToTransfer(commands);
  linear_.recordReadback(commands, size_bytes);
  recordTransferToHost(commands);
  recordComputeToHost(commands);
  timeline_.wait(recorder_.submit(timeline_));
  std::vector<float> picture(without_.size());
  std::memcpy(picture.data(), linear_.bytes().data(), size_bytes);
  return picture;
}

}  // namespace viewloom
