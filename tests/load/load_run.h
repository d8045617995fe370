// SPDX-License-Identifier: Apache-2.0
// Publishers and displays against one server for a while, and everything that was seen.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "frame/size.h"
#include "load/load_display.h"
#include "load/load_publisher.h"
#include "load/process_usage.h"

namespace viewloom::load {

struct LoadOptions {
  std::string server;     // address of one that runs; empty = start `viewloomd`
  std::string viewloomd;  // program
  uint32_t publishers = 2;
  uint32_t displays = 6;
  uint32_t slow_displays = 1;  // of them
  uint32_t seconds = 60;
  SizePx size_px{320, 180};
  uint32_t layer_count = 2;
  double rate_hz = 10;
};

struct LoadResult {
  double seconds = 0;  // from the first client to the first farewell
  std::vector<PublisherBook> publishers;
  std::vector<DisplayBook> displays;
  std::map<std::string, double> metrics;  // the server's, at the end; empty without a web server
  // For a server that the run starts; empty for one that ran before.
  std::vector<ProcessUsage> server_usage;  // once a second
  ProcessUsage client_usage;               // of this process, during the run
  int server_exit_code = 0;
};

// Throws std::runtime_error when the server cannot be started or reached.
LoadResult runLoad(const LoadOptions& options);

}  // namespace viewloom::load
