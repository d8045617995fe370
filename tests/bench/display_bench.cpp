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
#include "bench/built_frame.h"
#include "bench/display_loads.h"
#include "bench/report.h"
#include "offline/median.h"
#include "support/test_frames.h"

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
  TraceJob job;
  std::optional<SweepPlan> plan;  // where the server would sweep
  std::vector<double> ms;
};

Contender enter(DisplayLoad load, const BuiltFrame& frame) {
  Contender contender{.load = std::move(load)};
  contender.job = frame.jobOf(contender.load.spec);
  if (frame.device().info().is_software) {
    contender.plan = SweepPlan::make(contender.job, frame.inv_z_max());
  }
  return contender;
}

void trace(const Contender& contender, BuiltFrame& frame, SweptAtlas& swept) {
  const TraceJob& job = contender.job;
  if (contender.plan) {
    frame.sweep(job, *contender.plan, {}, swept);
    return;
  }
  TraceSlot slot(frame.device(), slotShape(job, kBandRows, {}));
  frame.walk(job, kBandRows, slot);
}

Json resultOf(const Contender& contender) {
  const SizePx size_px = contender.job.layout->size_px;
  return {{"name", contender.load.name},
          {"width_px", size_px.width},
          {"height_px", size_px.height},
          {"views", contender.job.layout->views.size()},
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
  BuiltFrame frame(device, test::syntheticFrame(1, source_px, kLayerCount));
  std::vector<Contender> contenders;
  for (DisplayLoad& load :
       displayLoads(arguments.miniature, arguments.cone_deg * std::numbers::pi / 180)) {
    if (load.name.find(arguments.only) == std::string::npos) continue;
    contenders.push_back(enter(std::move(load), frame));
  }
  if (contenders.empty()) {
    throw std::runtime_error("--only: no display has \"" + arguments.only + "\" in its name");
  }
  // Turn by turn; the first compiles, and warms the caches.
  SweptAtlas swept;
  for (int round = 0; round <= arguments.round_count; ++round) {
    for (Contender& contender : contenders) {
      contender.ms.push_back(timedMs([&] { trace(contender, frame, swept); }));
    }
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

void addDisplaysCommand(const usage::Command& app) {
  const auto arguments = std::make_shared<Arguments>();
  const usage::Command command = app.addCommand(
      "displays", "Trace the synthetic frame for every preset, as a quilt and in its panel's px");
  command.add("--device", arguments->device, "Vulkan device, as viewloomd --device");
  command.addFlag("--json", arguments->prints_json, "Print one JSON object");
  command.add("--rounds", arguments->round_count, "Rounds, for the medians").between(1, 1000);
  command.add("--only", arguments->only, "Displays whose name has this in it");
  command.add("--cone", arguments->cone_deg, "Degrees, instead of each preset's")
      .between(0.01, 140.0);
  command
      .add("--miniature", arguments->miniature,
           "Frames and displays so many times smaller on a side: tries the program out")
      .between(1, 32);
  command.onChosen([arguments] { measure(*arguments); });
}

}  // namespace viewloom::bench
