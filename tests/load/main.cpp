// SPDX-License-Identifier: Apache-2.0
// viewloom-load: synthetic publishers and displays against a server; prints JSON.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <optional>

#include "load/load_report.h"
#include "usage/command_line.h"

int main(int argc, char** argv) {
  viewloom::load::LoadOptions options;
  bool check = false;
  const viewloom::usage::CommandLine app(
      "Publishers and displays against viewloomd; prints what was measured as JSON.",
      "viewloom-load");
  const viewloom::usage::Option server =
      app.add("--server", options.server, "Address of a server that runs");
  app.add("--viewloomd", options.viewloomd, "Program to start, on free ports").excludes(server);
  app.add("--publishers", options.publishers).between(1, 100);
  app.add("--displays", options.displays, "Kinds go round").between(1, 1000);
  app.add("--slow-displays", options.slow_displays, "Of them, taking a second over each");
  app.add("--seconds", options.seconds).between(1, 86400);
  app.add("--width", options.size_px.width, "Of the frames, px").between(1, 8192);
  app.add("--height", options.size_px.height).between(1, 8192);
  app.add("--layers", options.layer_count).between(1, 4);
  app.add("--rate", options.rate_hz, "Frames per second and publisher").between(0.1, 1000.0);
  app.addFlag("--check", check, "Exit code 1 when a promise is broken (never about time)");
  if (const std::optional<int> code = app.parse(argc, argv)) return *code;
  if (options.server.empty() == options.viewloomd.empty()) {
    std::fprintf(stderr, "viewloom-load: give --server or --viewloomd\n");
    return 2;
  }
  options.slow_displays = std::min(options.slow_displays, options.displays);
  try {
    const viewloom::load::LoadResult result = viewloom::load::runLoad(options);
    std::printf("%s\n", viewloom::load::makeReport(options, result).dump(2).c_str());
    return check && !viewloom::load::findProblems(options, result).empty() ? 1 : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "viewloom-load: %s\n", error.what());
    return 2;
  }
}
