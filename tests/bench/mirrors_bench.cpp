// SPDX-License-Identifier: Apache-2.0
#include "bench/mirrors_bench.h"

#include <cstdio>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "base/log.h"
#include "bench/mirror_duels.h"
#include "bench/report.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Arguments {
  std::string device;
  std::string only;
  uint32_t round_count = 5;
  bool prints_json = false;
};

Json jsonOf(const MirrorPoint& point) {
  return {{"name", point.name},
          {"ms", point.time_ms},
          {"known_db", point.psnr.known_db},
          {"all_db", point.psnr.all_db}};
}

Json jsonOf(const std::vector<MirrorPoint>& points) {
  Json json = Json::array();
  for (const MirrorPoint& point : points) json.push_back(jsonOf(point));
  return json;
}

Json jsonOf(const MirrorDuel& duel) {
  const MirrorPoint& own = duel.walks.front();
  const MirrorPoint* const at_equal_time = duel.bestMarch(own.time_ms);
  const MirrorPoint* const as_good = duel.fastestMarch(own.psnr.all_db);
  return {{"scene", duel.scene},
          {"view", duel.view},
          {"without_all_db", duel.without.all_db},
          {"walk", jsonOf(own)},
          {"march_at_equal_time", at_equal_time ? jsonOf(*at_equal_time) : Json()},
          {"march_as_good", as_good ? jsonOf(*as_good) : Json()},
          {"best_march", jsonOf(duel.bestMarch())},
          {"walks", jsonOf(duel.walks)},
          {"marches", jsonOf(duel.marches)}};
}

std::string cellOf(const Json& point) {
  if (point.is_null()) return "-";
  char figures[64];
  std::snprintf(figures, sizeof figures, "%.3g ms, %.1f dB", point["ms"].get<double>(),
                point["all_db"].get<double>());
  return figures;
}

std::string namedCellOf(const Json& point) {
  return point.is_null() ? "-" : cellOf(point) + ": " + point["name"].get<std::string>();
}

void print(const Json& duels) {
  std::printf(
      "| scene, view | without, dB | walked | marched in no more time | marched, best | "
      "marched as well, fastest |\n|---|---|---|---|---|---|\n");
  for (const Json& duel : duels) {
    std::printf("| %s, %s | %.1f | %s | %s | %s | %s |\n", duel["scene"].get<std::string>().c_str(),
                duel["view"].get<std::string>().c_str(), duel["without_all_db"].get<double>(),
                cellOf(duel["walk"]).c_str(), namedCellOf(duel["march_at_equal_time"]).c_str(),
                namedCellOf(duel["best_march"]).c_str(), cellOf(duel["march_as_good"]).c_str());
  }
}

void measure(const Arguments& arguments) {
  setLogLevel(LogLevel::kWarning);
  const Device device({.select = arguments.device});
  Json json{{"device", device.info().name}, {"date", today()}, {"duels", Json::array()}};
  for (const MirrorScene& scene : mirrorScenes()) {
    if (std::string(scene.name).find(arguments.only) == std::string::npos) continue;
    std::cerr << scene.name << "\n";
    for (const MirrorDuel& duel : mirrorDuels(device, scene, arguments.round_count)) {
      json["duels"].push_back(jsonOf(duel));
    }
  }
  if (json["duels"].empty()) {
    throw std::runtime_error("--only: no scene has \"" + arguments.only + "\" in its name");
  }
  if (arguments.prints_json)
    std::cout << json.dump(2) << "\n";
  else
    print(json["duels"]);
}

}  // namespace

void addMirrorsCommand(const usage::Command& app) {
  const auto arguments = std::make_shared<Arguments>();
  const usage::Command command = app.addCommand(
      "mirrors", "Time and PSNR of reflected rays, walked and marched from px to px");
  command.add("--device", arguments->device, "Vulkan device, as viewloomd --device");
  command.addFlag("--json", arguments->prints_json, "Print one JSON object");
  command.add("--only", arguments->only, "Scenes whose name has this in it");
  command.add("--rounds", arguments->round_count, "Of each way, for the medians").between(1, 1000);
  command.onChosen([arguments] { measure(*arguments); });
}

}  // namespace viewloom::bench
