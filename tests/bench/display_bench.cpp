// SPDX-License-Identifier: Apache-2.0
#include "bench/display_bench.h"

#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/log.h"
#include "bench/display_loads.h"
#include "bench/report.h"
#include "commands/median.h"
#include "e2e/test_frames.h"
#include "gpu/command_recorder.h"
#include "gpu/timeline.h"
#include "structure/structure_builder.h"
#include "sweep/sweep_source.h"
#include "sweep/view_sweeper.h"
#include "trace/view_tracer.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr uint32_t kBandRows = 128;
constexpr SizePx kSource_px{1920, 1080};
constexpr uint32_t kLayerCount = 2;

struct Arguments {
  std::string device;
  std::string only;
  int round_count = 3;
  uint32_t miniature = 1;
  double cone_deg = 0;
  bool prints_json = false;
};

template <typename Work>
double timedMs(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

// One display of the frame, with what its trace needs.
struct Contender {
  DisplayLoad load;
  std::shared_ptr<const AtlasLayout> layout;
  TraceJob job;
  std::optional<SweepPlan> plan;  // where the server would sweep
  std::vector<double> ms;
};

class DisplayBench {
 public:
  DisplayBench(const Device& device, FramePtr frame)
      : device_(device),
        timeline_(device),
        recorder_(device),
        structure_(device, shapeOf(*frame)),
        tracer_(device) {
    sweep_source_.prepare(frame, workers_);
    structure_.upload(*frame);
    const StructureBuilder builder(device);
    builder.record(recorder_.begin(), structure_, nullptr);
    timeline_.wait(recorder_.submit(timeline_));
  }

  Contender enter(DisplayLoad load) const {
    const Camera& camera = structure_.sourceCamera();
    const SizePx source_px = structure_.shape().depth_px;
    Contender contender{.load = std::move(load)};
    contender.layout = std::make_shared<const AtlasLayout>(
        makeAtlasLayout(contender.load.spec,
                        {.source_intrinsics = camera.intrinsics,
                         .source_size_px = source_px,
                         .focal_distance_m = contentFocalDistance(structure_.stats())})
            .value());
    contender.job = makeTraceJob(contender.layout, contender.load.spec,
                                 displayPose(contender.load.spec, camera), camera, source_px);
    if (device_.info().is_software) {
      contender.plan = SweepPlan::make(contender.job, structure_.stats().inv_z_max);
    }
    return contender;
  }

  void trace(Contender& contender) {
    contender.ms.push_back(timedMs([&] { contender.plan ? sweep(contender) : walk(contender); }));
  }

 private:
  void sweep(const Contender& contender) {
    sweepAtlas({.job = &contender.job,
                .plan = &*contender.plan,
                .source = sweep_source_.rowSource(),
                .inv_z_max = float(structure_.stats().inv_z_max)},
               {}, workers_, sweepers_, swept_);
  }

  void walk(const Contender& contender) {
    const SizePx size_px = contender.layout->size_px;
    TraceSlot slot(device_, slotShape(contender.job, kBandRows, {}));
    for (uint32_t row = 0; row < size_px.height; row += kBandRows) {
      const BandRows rows{row, std::min(kBandRows, size_px.height - row)};
      tracer_.recordBand(recorder_.begin(), structure_, contender.job, rows, slot, nullptr);
      timeline_.wait(recorder_.submit(timeline_));
    }
  }

  const Device& device_;
  Timeline timeline_;
  CommandRecorder recorder_;
  StructureSlot structure_;
  ViewTracer tracer_;
  WorkerPool workers_;
  SweepSource sweep_source_;
  std::vector<ViewSweeper> sweepers_;
  SweptAtlas swept_;
};

Json resultOf(const Contender& contender) {
  const SizePx size_px = contender.layout->size_px;
  return {{"name", contender.load.name},
          {"width_px", size_px.width},
          {"height_px", size_px.height},
          {"views", contender.layout->views.size()},
          {"method", contender.plan ? "sweep" : "walk"},
          {"trace_ms", medianOf(contender.ms)}};
}

void print(const Json& json) {
  std::printf("| display | px | method | ms |\n|---|---|---|---|\n");
  for (const Json& load : json["displays"]) {
    std::printf("| %s | %ux%u | %s | %.3g |\n", load["name"].get<std::string>().c_str(),
                load["width_px"].get<unsigned>(), load["height_px"].get<unsigned>(),
                load["method"].get<std::string>().c_str(), load["trace_ms"].get<double>());
  }
}

void measure(const Arguments& arguments) {
  setLogLevel(LogLevel::kWarning);
  const Device device({.select = arguments.device});
  const SizePx source_px{kSource_px.width / arguments.miniature,
                         kSource_px.height / arguments.miniature};
  DisplayBench bench(device, test::syntheticFrame(1, source_px, kLayerCount));
  std::vector<Contender> contenders;
  for (DisplayLoad& load :
       displayLoads(arguments.miniature, arguments.cone_deg * std::numbers::pi / 180)) {
    if (load.name.find(arguments.only) == std::string::npos) continue;
    contenders.push_back(bench.enter(std::move(load)));
  }
  if (contenders.empty()) {
    throw std::runtime_error("--only: no display has \"" + arguments.only + "\" in its name");
  }
  // Turn by turn; the first compiles, and warms the caches.
  for (int round = 0; round <= arguments.round_count; ++round) {
    for (Contender& contender : contenders) bench.trace(contender);
  }
  Json json{{"device", device.info().name}, {"date", today()}, {"displays", Json::array()}};
  for (Contender& contender : contenders) {
    contender.ms.erase(contender.ms.begin());
    json["displays"].push_back(resultOf(contender));
  }
  if (arguments.prints_json)
    std::cout << json.dump(2) << "\n";
  else
    print(json);
}

}  // namespace

void addDisplaysCommand(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = app.add_subcommand(
      "displays", "Trace the synthetic frame for every preset, as a quilt and in its panel's px");
  command->add_option("--device", arguments->device, "Vulkan device, as viewloomd --device");
  command->add_flag("--json", arguments->prints_json, "Print one JSON object");
  command->add_option("--rounds", arguments->round_count, "Rounds, for the medians")
      ->check(CLI::Range(1, 1000));
  command->add_option("--only", arguments->only, "Displays whose name has this in it");
  command->add_option("--cone", arguments->cone_deg, "Degrees, instead of each preset's")
      ->check(CLI::Range(0.01, 140.0));
  command
      ->add_option("--miniature", arguments->miniature,
                   "Frames and displays so many times smaller on a side: tries the program out")
      ->check(CLI::Range(1, 32));
  command->callback([arguments] { measure(*arguments); });
}

}  // namespace viewloom::bench
