// SPDX-License-Identifier: Apache-2.0
#include "bench/stereo_bench.h"

#include <cstdio>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/log.h"
#include "bench/bare_work.h"
#include "bench/eye_service.h"
#include "bench/report.h"
#include "support/test_frames.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr SizePx kSource_px{960, 540};
constexpr uint32_t kLayerCount = 2;
constexpr double kHeadset_hz = 90;
constexpr double kFlood_hz = 10'000;
constexpr uint32_t kManyViewers = 8;
constexpr SizePx kQuilt_px{8192, 8192};

struct Arguments {
  std::string device;
  std::string only;
  uint32_t miniature = 1;
  double seconds = 5;
  bool prints_json = false;
};

struct NamedLoad {
  std::string name;
  EyeLoad load;
};

std::string nameOf(const std::string& head, const EyeLoad& load) {
  return head + ", " + std::to_string(load.viewer_count) + " at " +
         std::to_string(int(load.rate_hz)) + " Hz";
}

std::vector<NamedLoad> eyeLoads(const Arguments& arguments) {
  const uint32_t by = arguments.miniature;
  std::vector<NamedLoad> loads;
  for (const HeadMotion motion : {HeadMotion::kAside, HeadMotion::kFree}) {
    const std::string head = motion == HeadMotion::kAside ? "aside" : "free";
    EyeLoad load{.motion = motion, .seconds = arguments.seconds};
    load.eye_px = {load.eye_px.width / by, load.eye_px.height / by};
    for (const uint32_t viewer_count : {1u, kManyViewers}) {
      for (const double rate_hz : {kHeadset_hz, kFlood_hz}) {
        load.viewer_count = viewer_count;
        load.rate_hz = rate_hz;
        load.is_all_at_once = rate_hz == kFlood_hz;  // no timer tells such phases apart
        loads.push_back({nameOf(head, load), load});
      }
    }
    load.rate_hz = kHeadset_hz;
    load.is_all_at_once = true;
    loads.push_back({nameOf(head, load) + ", all at once", load});
    load.is_all_at_once = false;
    load.viewer_count = 1;
    load.quilt_px = {kQuilt_px.width / by, kQuilt_px.height / by};
    loads.push_back({nameOf(head, load) + " beside a quilt", load});
  }
  return loads;
}

Json resultOf(const NamedLoad& load, const EyeFigures& figures, const load::Percentiles& bare) {
  const auto percentiles = [](const load::Percentiles& samples) {
    return Json{{"p50", samples.atMs(0.5)}, {"p99", samples.atMs(0.99)}};
  };
  Json json{{"name", load.name},
            {"viewers", load.load.viewer_count},
            {"poses_hz", load.load.rate_hz},
            {"eye_px", {load.load.eye_px.width, load.load.eye_px.height}},
            {"answers", figures.answered.count()},
            {"answered_ms", percentiles(figures.answered)},
            {"waited_ms", percentiles(figures.waited)},
            {"made_ms", percentiles(figures.made)},
            {"bare_ms", percentiles(bare)}};
  const double made_ms = figures.made.atMs(0.5);
  if (made_ms > 0) {
    json["p99_over_made"] = figures.answered.atMs(0.99) / made_ms;
    json["bare_p99_over_p50"] = bare.atMs(0.99) / bare.atMs(0.5);
  }
  if (load.load.quilt_px.area() > 0) {
    json["quilt_px"] = {load.load.quilt_px.width, load.load.quilt_px.height};
    json["quilts_per_s"] = double(figures.quilt_count) / load.load.seconds;
  }
  return json;
}

void print(const Json& json) {
  std::printf(
      "| heads | answers | p50 ms | p99 ms | traced and encoded, p50 ms | p99 / that | "
      "p99 / p50 of as much arithmetic |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (const Json& load : json["loads"]) {
    std::printf("| %s | %zu | %.3g | %.3g | %.3g | %.2f | %.2f |\n",
                load["name"].get<std::string>().c_str(), load["answers"].get<size_t>(),
                load["answered_ms"]["p50"].get<double>(), load["answered_ms"]["p99"].get<double>(),
                load["made_ms"]["p50"].get<double>(), load.value("p99_over_made", 0.0),
                load.value("bare_p99_over_p50", 0.0));
  }
}

void measure(const Arguments& arguments) {
  setLogLevel(LogLevel::kWarning);
  const Device device({.select = arguments.device});
  const SizePx source_px{kSource_px.width / arguments.miniature,
                         kSource_px.height / arguments.miniature};
  const std::vector<FramePtr> frames{test::syntheticFrame(1, source_px, kLayerCount, 0),
                                     test::syntheticFrame(2, source_px, kLayerCount, 0.5)};
  Json json{{"device", device.info().name}, {"date", today()}, {"loads", Json::array()}};
  for (const NamedLoad& load : eyeLoads(arguments)) {
    if (load.name.find(arguments.only) == std::string::npos) continue;
    std::cerr << load.name << "\n";
    const EyeFigures figures = measureEyes(device, frames, load.load);
    // Right after it: hosts that are shared have their hours. As often as poses come.
    const load::Percentiles bare = measureBareWork(
        figures.made.atMs(0.5), load.load.viewer_count * load.load.rate_hz, arguments.seconds);
    json["loads"].push_back(resultOf(load, figures, bare));
  }
  if (json["loads"].empty()) {
    throw std::runtime_error("--only: no load has \"" + arguments.only + "\" in its name");
  }
  if (arguments.prints_json)
    std::cout << json.dump(2) << "\n";
  else
    print(json);
}

}  // namespace

void addStereoCommand(const usage::Command& app) {
  const auto arguments = std::make_shared<Arguments>();
  const usage::Command command = app.addCommand(
      "stereo", "Serve tracked stereo displays: from poses in to the last band of their picture");
  command.add("--device", arguments->device, "Vulkan device, as viewloomd --device");
  command.addFlag("--json", arguments->prints_json, "Print one JSON object");
  command.add("--only", arguments->only, "Loads whose name has this in it");
  command.add("--seconds", arguments->seconds, "Of each load").between(0.1, 600.0);
  command
      .add("--miniature", arguments->miniature,
           "Frames and displays so many times smaller on a side: tries the program out")
      .between(1, 32);
  command.onChosen([arguments] { measure(*arguments); });
}

}  // namespace viewloom::bench
