// SPDX-License-Identifier: Apache-2.0
#include "bench/knob.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "base/log.h"
#include "bench/report.h"
#include "offline/median.h"
#include "scoring/psnr.h"
#include "walk/offline_renderer.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

struct NamedQuality {
  Quality quality;
  const char* name;
};

constexpr std::array kQualities = {NamedQuality{Quality::kDraft, "draft"},
                                   NamedQuality{Quality::kBalanced, "balanced"},
                                   NamedQuality{Quality::kBest, "best"}};

struct Arguments {
  std::string device;
  uint32_t round_count = 5;
  uint32_t miniature = 1;
  bool prints_json = false;
};

template <typename Value>
Value valueOrThrow(absl::StatusOr<Value> value) {
  if (!value.ok()) throw std::runtime_error(std::string(value.status().message()));
  return *std::move(value);
}

RenderedAtlas render(OfflineRenderer& renderer, const DisplaySpec& spec, bool is_linear) {
  return valueOrThrow(renderer.render(spec, {.linear = is_linear}, [](uint32_t, uint32_t) {}));
}

double psnrDb(const RenderedAtlas& atlas, const KnobLoad& load) {
  Psnr psnr;
  for (size_t px = 0; px < load.is_known.size(); ++px) {
    if (load.is_known[px] == 0) continue;
    for (size_t c = 0; c < 3; ++c) {
      psnr.add(atlas.linear[4 * px + c] - load.truth.rgb[3 * px + c]);
    }
  }
  return psnr.db();
}

void print(const std::vector<KnobPoint>& points) {
  std::printf("| application | quality | ms | PSNR, dB |\n|---|---|---|---|\n");
  for (const KnobPoint& point : points) {
    std::printf("| %s | %s | %.3g | %.1f |\n", point.application.c_str(),
                kQualities.at(size_t(point.quality)).name, point.trace_ms, point.psnr_db);
  }
}

void printJson(const Device& device, const std::vector<KnobPoint>& points) {
  Json json{{"device", device.info().name}, {"date", today()}, {"points", Json::array()}};
  for (const KnobPoint& point : points) {
    json["points"].push_back({{"application", point.application},
                              {"quality", kQualities.at(size_t(point.quality)).name},
                              {"trace_ms", point.trace_ms},
                              {"psnr_db", point.psnr_db}});
  }
  std::cout << json.dump(2) << "\n";
}

void measure(const Arguments& arguments) {
  setLogLevel(LogLevel::kWarning);
  const Device device({.select = arguments.device});
  std::vector<KnobPoint> points;
  for (const KnobLoad& load : knobLoads(arguments.miniature)) {
    std::cerr << load.application << "\n";
    const auto of_load = knobPoints(device, load, arguments.round_count);
    points.insert(points.end(), of_load.begin(), of_load.end());
  }
  if (arguments.prints_json)
    printJson(device, points);
  else
    print(points);
}

}  // namespace

std::vector<KnobPoint> knobPoints(const Device& device, const KnobLoad& load,
                                  uint32_t round_count) {
  OfflineRenderer renderer(device);
  renderer.build(*load.frame);
  std::vector<KnobPoint> points;
  std::vector<DisplaySpec> specs;
  for (const NamedQuality& named : kQualities) {
    DisplaySpec spec = load.display;
    spec.quality = named.quality;
    specs.push_back(valueOrThrow(completeDisplaySpec(std::move(spec))));
    points.push_back({.application = load.application,
                      .quality = named.quality,
                      .psnr_db = psnrDb(render(renderer, specs.back(), true), load)});
  }
  std::array<std::vector<double>, kQualities.size()> times_ms;
  // The first round compiles, and makes room.
  for (uint32_t round = 0; round <= round_count; ++round) {
    for (size_t i = 0; i < specs.size(); ++i) {
      const auto begun = std::chrono::steady_clock::now();
      render(renderer, specs[i], false);
      const std::chrono::duration<double, std::milli> took =
          std::chrono::steady_clock::now() - begun;
      if (round > 0) times_ms[i].push_back(took.count());
    }
  }
  for (size_t i = 0; i < specs.size(); ++i) points[i].trace_ms = medianOf(times_ms[i]);
  return points;
}

void addKnobCommand(const usage::Command& app) {
  const auto arguments = std::make_shared<Arguments>();
  const usage::Command command = app.addCommand(
      "knob", "Time over PSNR of draft, balanced and best, for each application of the tracer");
  command.add("--device", arguments->device, "Vulkan device, as viewloomd --device");
  command.addFlag("--json", arguments->prints_json, "Print one JSON object");
  command.add("--rounds", arguments->round_count, "Of each trace, for the median").between(1, 1000);
  command
      .add("--miniature", arguments->miniature,
           "Frames and displays so many times smaller on a side: tries the program out")
      .between(1, 8);
  command.onChosen([arguments] { measure(*arguments); });
}

}  // namespace viewloom::bench
