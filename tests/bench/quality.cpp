// SPDX-License-Identifier: Apache-2.0
#include "bench/quality.h"

#include <iostream>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "base/log.h"
#include "bench/quality_lens.h"
#include "bench/quality_reflections.h"
#include "bench/quality_stereo.h"
#include "bench/quality_time.h"
#include "gpu/device.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Section {
  const char* name;
  Json (*score)(const Device& device);
};

constexpr Section kSections[] = {{"lens", qualityOfLens},
                                 {"stereo", qualityOfStereo},
                                 {"time", qualityOfTime},
                                 {"reflections", qualityOfReflections}};

struct Arguments {
  std::string device;
  std::string only;
  bool prints_json = false;
};

void scoreAll(const Arguments& arguments) {
  setLogLevel(LogLevel::kWarning);
  const Device device({.select = arguments.device});
  Json json{{"device", device.info().name}};
  for (const Section& section : kSections) {
    if (!arguments.only.empty() && arguments.only != section.name) continue;
    std::cerr << "section " << section.name << "\n";
    json[section.name] = section.score(device);
    if (!arguments.prints_json) {
      std::cout << section.name << "\n";
      for (const Json& row : json[section.name]) std::cout << "  " << row.dump() << "\n";
    }
  }
  if (arguments.prints_json) std::cout << json.dump(2) << "\n";
}

}  // namespace

void addQualityCommand(const usage::Command& app) {
  const auto arguments = std::make_shared<Arguments>();
  const usage::Command command =
      app.addCommand("quality", "Score the applications of the tracer beside the truth");
  command.add("--device", arguments->device, "Vulkan device, as viewloomd --device");
  command.addFlag("--json", arguments->prints_json, "Print one JSON object at the end");
  std::vector<std::string> names;
  for (const Section& section : kSections) names.emplace_back(section.name);
  command.add("--only", arguments->only, "This section alone").oneOf(names);
  command.onChosen([arguments] { scoreAll(*arguments); });
}

}  // namespace viewloom::bench
