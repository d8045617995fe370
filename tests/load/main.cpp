// SPDX-License-Identifier: Apache-2.0
// viewloom-load: synthetic publishers and displays against a server; prints JSON.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>

#include "load/load_report.h"

int main(int argc, char** argv) {
  viewloom::load::LoadOptions options;
  bool check = false;
  CLI::App app("Publishers and displays against viewloomd; prints what was measured as JSON.",
               "viewloom-load");
  auto* server = app.add_option("--server", options.server, "Address of a server that runs");
  app.add_option("--viewloomd", options.viewloomd, "Program to start, on free ports")
      ->excludes(server);
  app.add_option("--publishers", options.publishers)->check(CLI::Range(1, 100));
  app.add_option("--displays", options.displays, "Kinds go round")->check(CLI::Range(1, 1000));
  app.add_option("--slow-displays", options.slow_displays, "Of them, taking a second over each");
  app.add_option("--seconds", options.seconds)->check(CLI::Range(1, 86400));
  app.add_option("--width", options.size_px.width, "Of the frames, px")->check(CLI::Range(1, 8192));
  app.add_option("--height", options.size_px.height)->check(CLI::Range(1, 8192));
  app.add_option("--layers", options.layer_count)->check(CLI::Range(1, 4));
  app.add_option("--rate", options.rate_hz, "Frames per second and publisher")
      ->check(CLI::Range(0.1, 1000.0));
  app.add_flag("--check", check, "Exit code 1 when a promise is broken (never about time)");
  CLI11_PARSE(app, argc, argv);
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
