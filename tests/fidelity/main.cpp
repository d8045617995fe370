// SPDX-License-Identifier: Apache-2.0
// viewloom-fidelity: viewloom and simple depth warps against true views, by one mask.
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

#include "base/log.h"
#include "fidelity/report.h"
#include "usage/command_line.h"

namespace viewloom::fidelity {

static void run(const std::filesystem::path& data, const std::string& device_name,
                bool prints_json) {
  setLogLevel(LogLevel::kWarning);
  const Device device({.select = device_name});
  OfflineRenderer renderer(device);
  nlohmann::ordered_json json{{"device", device.info().name},
                              {"sets", nlohmann::ordered_json::array()}};
  for (const Trial& trial : loadTrials(data)) {
    json["sets"].push_back(trialJson(trial, runTrial(renderer, trial)));
    if (!prints_json) std::cout << asTable(json["sets"].back()) << std::endl;
  }
  if (prints_json) std::cout << json.dump(2) << "\n";
}

}  // namespace viewloom::fidelity

int main(int argc, char** argv) {
  const viewloom::usage::CommandLine app(
      "Scores viewloom and simple depth warps against true views of recorded sets");
  std::filesystem::path data;
  std::string device;
  bool prints_json = false;
  app.add("--data", data, "Folder with beachball-stereo and hci-antinous")
      .required()
      .existingFolder();
  app.add("--device", device, "Vulkan device, as viewloomd --device");
  app.addFlag("--json", prints_json, "Print one JSON object at the end");
  if (const std::optional<int> code = app.parse(argc, argv)) return *code;
  try {
    viewloom::fidelity::run(data, device, prints_json);
  } catch (const std::exception& error) {
    std::cerr << "viewloom-fidelity: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
