// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_commands.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/log.h"
#include "bench/application_pictures.h"
#include "bench/cpu/cpu_rivals.h"
#include "bench/display_bench.h"
#include "bench/gpu/gpu_rivals.h"
#include "bench/ingest_bench.h"
#include "bench/knob.h"
#include "bench/load_list.h"
#include "bench/markdown.h"
#include "bench/mirrors_bench.h"
#include "bench/quality.h"
#include "bench/recorded_loads.h"
#include "bench/report.h"
#include "bench/retime_bench.h"
#include "bench/side_by_side.h"
#include "bench/stereo_bench.h"
#include "bench/targets.h"
#include "bench/tick_bench.h"
#include "bench/uplink.h"
#include "bench/video_bench.h"
#include "bench/viewloom_contestant.h"
#include "usage/command_line.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Arguments {
  std::string device;
  bool is_full = false;
  bool prints_json = false;
  bool prints_table = false;
  int round_count = 5;
  std::string only;
  uint32_t miniature = 1;
  std::filesystem::path data = VIEWLOOM_SHARED_DATA;
  std::vector<std::filesystem::path> manifests;
};

RecordedLoads chosenLoads(const Arguments& arguments, Work work) {
  RecordedLoads all = recordedLoads(arguments.data);
  std::vector<NamedLoad> loads = work == Work::kBuild ? buildLoads()
                                 : arguments.is_full  ? fullLoads()
                                                      : quickLoads();
  std::move(all.loads.begin(), all.loads.end(), std::back_inserter(loads));
  for (const auto& path : arguments.manifests) loads.push_back(manifestLoad(path));
  RecordedLoads chosen;
  std::string names;
  const auto isWanted = [&](const auto& load) {
    names += "\n  " + load.name;
    return load.name.find(arguments.only) != std::string::npos;
  };
  std::copy_if(loads.begin(), loads.end(), std::back_inserter(chosen.loads), isWanted);
  std::copy_if(all.skipped.begin(), all.skipped.end(), std::back_inserter(chosen.skipped),
               isWanted);
  if (chosen.loads.empty() && chosen.skipped.empty()) {
    throw std::runtime_error("--only: no load has \"" + arguments.only + "\" in its name:" + names);
  }
  return chosen;
}

MemoryUse sweptMemory(const BenchLoad& load) {
  WorkerPool workers;
  const auto plan = SweepPlan::make(load.job, double{load.source.inv_z_max});
  return sweepMemory(*load.frame, load.job, *plan, workers);
}

Json measure(const Device& device, const BenchLoad& load, Work work, int round_count) {
  // Anew for each load: what one needed is not there for the next.
  std::vector<std::unique_ptr<Contestant>> contestants;
  auto serving = std::make_unique<ViewloomContestant>(device, true);
  auto walking = std::make_unique<ViewloomContestant>(device, false);
  const bool is_swept = serving->isSwept(load);
  ViewloomContestant& walk = is_swept ? *walking : *serving;
  contestants.push_back(std::move(serving));
  contestants.push_back(std::move(walking));
  for (auto& rival : makeGpuRivals(device)) contestants.push_back(std::move(rival));
  for (auto& rival : makeCpuRivals()) contestants.push_back(std::move(rival));
  const LoadReport report = runSideBySide(load, contestants, work, round_count, "dda");
  if (work == Work::kBuild) return buildJson(report);
  OwnReport own{.method = is_swept ? TraceMethod::kSweep : TraceMethod::kWalk,
                .visits = walk.visits(),
                .walk = {},
                .sweep = {}};
  contestants.clear();  // makes room
  own.walk = walkMemory(device, *load.frame, load.job);
  if (is_swept && canMeasureSweeps()) own.sweep = sweptMemory(load);
  return traceJson(report, own);
}

void measureAll(const Arguments& arguments, Work work) {
  setLogLevel(LogLevel::kWarning);
  const Device device({.select = arguments.device});
  const LoadMaker maker(device, arguments.miniature);
  Json json{{"device", device.info().name}, {"date", today()}, {"loads", Json::array()}};
  const auto [loads, skipped] = chosenLoads(arguments, work);
  for (const SkippedLoad& load : skipped) {
    json["skipped"].push_back({{"name", load.name}, {"reason", load.reason}});
  }
  for (size_t i = 0; i < loads.size(); ++i) {
    std::cerr << "load " << i + 1 << " of " << loads.size() << ": " << loads[i].name << "\n";
    json["loads"].push_back(measure(device, loads[i].make(maker), work, arguments.round_count));
    const bool waits = arguments.prints_json || arguments.prints_table;
    if (!waits) std::cout << asTable(json["loads"].back()) << std::endl;
  }
  json["ratios"] = targetRatios(json["loads"]);
  if (arguments.prints_json) {
    std::cout << json.dump(2) << "\n";
  } else if (arguments.prints_table) {
    std::cout << asMarkdown(json);
  } else {
    std::cout << targetsAsMarkdown(json["ratios"]);
  }
}

void addCommand(const usage::Command& app, const char* name, const char* description, Work work) {
  const auto arguments = std::make_shared<Arguments>();
  const usage::Command command = app.addCommand(name, description);
  command.add("--device", arguments->device, "Vulkan device, as viewloomd --device");
  const usage::Option json =
      command.addFlag("--json", arguments->prints_json, "Print one JSON object at the end");
  command.addFlag("--table", arguments->prints_table, "Print tables in markdown at the end")
      .excludes(json);
  command.add("--rounds", arguments->round_count, "Rounds of each load, for the medians")
      .between(1, 1000);
  command.add("--only", arguments->only, "Loads whose name has this in it");
  command
      .add("--miniature", arguments->miniature,
           "Scenes and tiles so many times smaller on a side: tries the program out")
      .between(1, 32);
  command.add("--data", arguments->data, "Folder of the recorded sets").showDefault();
  command.add("--frame", arguments->manifests, "FrameManifest to add as a load; repeatable")
      .existingFile();
  if (work == Work::kBuildAndTrace) {
    command.addFlag("--full,!--quick", arguments->is_full,
                    "Every scene with every display, and 4K; default: two dozen loads");
  }
  command.onChosen([arguments, work] { measureAll(*arguments, work); });
}

}  // namespace

int runBench(int argc, char** argv) {
  const usage::CommandLine app("Times viewloom beside its rivals on the same frames");
  app.requireCommand();
  addCommand(app, "trace", "Build and trace whole atlases", Work::kBuildAndTrace);
  addCommand(app, "build", "Build structures alone", Work::kBuild);
  addDisplaysCommand(app);
  addUplinkCommand(app);
  addIngestCommand(app);
  addStereoCommand(app);
  addKnobCommand(app);
  addMirrorsCommand(app);
  addRetimeCommand(app);
  addTicksCommand(app);
  addVideoCommand(app);
  addQualityCommand(app);
  addPicturesCommand(app);
  if (const std::optional<int> code = app.parse(argc, argv)) return *code;
  return 0;
}

}  // namespace viewloom::bench
