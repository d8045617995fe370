// SPDX-License-Identifier: Apache-2.0
#include "offline/engine_commands.h"

#include <sys/resource.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "base/log.h"
#include "base/processor_count.h"
#include "messages/display_from_proto.h"
#include "offline/atlas_pictures.h"
#include "offline/loopback_bench.h"
#include "offline/manifest_frame.h"
#include "offline/stage_bench.h"
#include "synthetic/synthetic_wire_frame.h"
#include "usage/command_line.h"

namespace viewloom {
namespace {

using Json = nlohmann::ordered_json;

constexpr SizePx kSource_px = {1920, 1080};
constexpr uint32_t kLayerCount = 2;
constexpr uint32_t kNodeBytes = sizeof(abi::uvec2);  // as in abi::Structure
constexpr char kPreset[] = "portrait";
// Frames that the loopback run publishes in turn: enough that no two in flight are the same.
constexpr uint32_t kLoopFrameCount = 8;
constexpr double kFrameInterval_s = 1.0 / 30;

struct BenchArguments {
  uint32_t repetition_count = 7;
  double seconds = 10;
  double cone_deg = 40;  // the preset's
};

SyntheticOptions sceneAt(double time_s) {
  return {.size_px = kSource_px, .layer_count = kLayerCount, .time_s = time_s, .camera = {}};
}

std::vector<WireFrame> syntheticFrames() {
  std::vector<WireFrame> frames;
  for (uint32_t i = 0; i < kLoopFrameCount; ++i) {
    frames.push_back(syntheticWireFrame(sceneAt(i * kFrameInterval_s), int64_t{i}));
  }
  return frames;
}

uint64_t peakResidentBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return uint64_t(usage.ru_maxrss) * 1024;
}

Json stagesJson(const StageReport& report) {
  const auto stage = [](double ms, uint64_t per, const char* unit) {
    return Json{{"ms", ms}, {unit, ms * 1e6 / static_cast<double>(per)}};
  };
  Json json;
  json["upload"] = stage(report.upload_ms, report.source_px, "ns_per_sample");
  json["build"] = stage(report.build_ms, report.source_px, "ns_per_sample");
  json["build_passes_ms"] = report.build_pass_ms;
  if (report.sweep_ms) {
    json["sweep_source"] = stage(*report.sweep_source_ms, report.source_px, "ns_per_sample");
    json["sweep"] = stage(*report.sweep_ms, report.ray_count, "ns_per_ray");
  }
  json["trace"] = stage(report.trace_ms, report.ray_count, "ns_per_ray");
  json["readback"] = stage(report.readback_ms, report.ray_count, "ns_per_ray");
  json["encode_one_thread"] = stage(report.encode_ms, report.ray_count, "ns_per_ray");
  json["rays"] = report.ray_count;
  json["encoded_bytes"] = report.encoded_bytes;
  return json;
}

Json visitsJson(const Device& device, const Frame& frame, const DisplaySpec& spec) {
  OfflineRenderer renderer(device);
  renderer.build(frame);
  const auto atlas =
      renderer.render(spec, {.mask = true, .records = true}, [](uint32_t, uint32_t) {});
  if (!atlas.ok()) throw std::runtime_error(std::string(atlas.status().message()));
  const VisitStats visits = visitStats(*atlas);
  return {{"mean", visits.mean}, {"p99", visits.p99}, {"max", visits.max}};
}

Json memoryJson(const StageReport& report, const Config& config) {
  Json json;
  json["per_stream_bytes"] =
      report.structure_bytes * config.pipeline.structure_slots + report.build_bytes;
  json["per_set_of_display_planes_bytes"] = report.trace_slot_bytes * config.pipeline.trace_slots;
  if (report.sweep_ms) {
    json["per_swept_stream_bytes"] = report.swept_frame_bytes * config.pipeline.structure_slots;
    json["swept_atlases_bytes"] = report.swept_atlas_bytes * config.pipeline.trace_slots;
  }
  json["per_display_bytes"] = report.encoded_bytes;     // its newest atlas, shared by all who watch
  json["per_subscriber_bytes"] = report.encoded_bytes;  // an atlas on its way, until it is sent
  json["process_peak_bytes"] = peakResidentBytes();
  return json;
}

Json loopbackJson(const LoopbackReport& report) {
  Json json;
  json["atlases_per_s"] = static_cast<double>(report.atlas_count) / report.seconds;
  json["skipped"] = report.skipped_count;
  json["bytes_per_atlas"] = report.atlas_bytes / std::max<uint64_t>(report.atlas_count, 1);
  json["mean_ms"] = {{"receive", report.receive_ms}, {"decode", report.decode_ms},
                     {"upload", report.upload_ms},   {"build", report.build_ms},
                     {"wait", report.wait_ms},       {"trace", report.trace_ms},
                     {"encode", report.encode_ms},   {"total", report.total_ms}};
  json["share_of_none_of_these"] = report.other_share;
  return json;
}

int bench(const BenchArguments& arguments, const Config& config) {
  setLogLevel(LogLevel::kWarning);
  std::cerr << "preparing the scene\n";
  const std::vector<WireFrame> frames = syntheticFrames();
  const FramePtr frame = makeSyntheticFrame(sceneAt(0));
  v1::Display display;
  display.mutable_quilt()->set_preset(kPreset);
  display.mutable_quilt()->set_view_cone_rad(arguments.cone_deg * std::numbers::pi / 180);
  const auto spec = displayFromProto(display);
  if (!spec.ok()) throw std::runtime_error(std::string(spec.status().message()));

  Json json;
  StageReport stages;
  {
    std::cerr << "measuring each stage by itself\n";
    const Device device({.select = config.device});
    stages = measureStages(device, frame, *spec, EncodingSpec{}, arguments.repetition_count);
    json["device"] = device.info().name;
    json["driver"] = device.info().driver;
    json["cores"] = processorCount();
    json["scene"] = {
        {"width_px", kSource_px.width},   {"height_px", kSource_px.height},
        {"layers", kLayerCount},          {"display", kPreset},
        {"cone_deg", arguments.cone_deg}, {"disparity_span_px", stages.disparity_span_px}};
    json["stages"] = stagesJson(stages);
    json["structure"] = {{"stored_nodes_per_px", stages.stored_nodes_per_px},
                         {"effective_nodes_per_px", stages.effective_nodes_per_px},
                         {"bytes_per_node", kNodeBytes},
                         {"bytes_per_px_and_layer", stages.structure_bytes_per_px}};
    json["visits_per_ray"] = visitsJson(device, *frame, *spec);
  }
  std::cerr << "running server, publisher and viewer together for " << arguments.seconds << " s\n";
  const auto loopback = measureLoopback(config, display, frames, arguments.seconds);
  if (!loopback.ok()) throw std::runtime_error(std::string(loopback.status().message()));
  json["loopback"] = loopbackJson(*loopback);
  json["memory"] = memoryJson(stages, config);
  std::cout << json.dump(2, ' ', true, nlohmann::json::error_handler_t::replace) << "\n";
  return 0;
}

}  // namespace

namespace cli {

RunCommand addBenchCommand(const usage::Command& command) {
  const auto arguments = std::make_shared<BenchArguments>();
  command.footer(
      "The scene has 1920x1080 pixels in two layers, and is rendered as a quilt for the preset "
      "portrait.\n"
      "The report is JSON on standard output.\n"
      "Examples:\n"
      "  viewloom bench\n"
      "  viewloom bench --repeat 3 --seconds 5 --cone 20");
  command
      .add("--repeat", arguments->repetition_count,
           "Measurements of each stage, 1 to 1000; the report has the median")
      .between(1, 1000)
      .showDefault();
  command
      .add("--seconds", arguments->seconds,
           "Length of the run of server, publisher and viewer, 0.1 to 3600")
      .valueName("SECONDS")
      .between(0.1, 3600.0)
      .showDefault();
  command
      .add("--cone", arguments->cone_deg,
           "Angle between the outermost views, 0.01 to 140; a larger angle costs more")
      .valueName("DEGREES")
      .between(0.01, 140.0)
      .showDefault();
  return withEngineSettings(
      command, {"device", "validation", "log.", "limits.", "pipeline."},
      [arguments](const Config& config) { return bench(*arguments, config); });
}

}  // namespace cli
}  // namespace viewloom
