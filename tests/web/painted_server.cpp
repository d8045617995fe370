// SPDX-License-Identifier: Apache-2.0
// The web server in front of two streams: "painted", and "silent" that never gives an atlas. Prints
// its URL; obeys lines on standard input: "frame" publishes a frame, "refuse" ends all displays
// with an error; their end drains and ends the server.
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "web/http_server.h"
#include "web/painted_stream.h"

namespace {

// An option with text; the others are numbers.
constexpr const char* kAllowOrigin = "--allow-origin";

// Access tokens are those of the file in the variable PAINTED_TOKEN_FILE.
// Options are pairs: --port 0 --rate-hz 10 --connections 1024 --timeout-ms 10000 --thread-count 2
// --idle-ms 20000 --transfer-ms 60000 --displays 64 --flat 0 (1: a view is one grey, black the
// first and white the last).
std::map<std::string, int> readOptions(int argc, char** argv) {
  std::map<std::string, int> options = {{"--port", 0},
                                        {"--rate-hz", 0},
                                        {"--connections", 1024},
                                        {"--timeout-ms", 10'000},
                                        {"--thread-count", 2},
                                        {"--idle-ms", 20'000},
                                        {"--transfer-ms", 60'000},
                                        {"--ms-per-megapixel", 0},
                                        {"--displays", 64},
                                        {"--flat", 0}};
  for (int i = 1; i + 1 < argc; i += 2) {
    if (argv[i] != std::string(kAllowOrigin)) options.at(argv[i]) = std::atoi(argv[i + 1]);
  }
  return options;
}

std::vector<std::string> allowedOrigins(int argc, char** argv) {
  std::vector<std::string> origins;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (argv[i] == std::string(kAllowOrigin)) origins.emplace_back(argv[i + 1]);
  }
  return origins;
}

viewloom::HttpOptions httpOptions(const std::map<std::string, int>& options) {
  viewloom::HttpOptions http;
  http.port = static_cast<uint16_t>(options.at("--port"));
  http.thread_count = static_cast<uint32_t>(options.at("--thread-count"));
  http.connection_count_max = static_cast<uint32_t>(options.at("--connections"));
  http.request_timeout = std::chrono::milliseconds(options.at("--timeout-ms"));
  http.still_timeout = http.request_timeout;
  http.idle_timeout = std::chrono::milliseconds(options.at("--idle-ms"));
  http.transfer_timeout = std::chrono::milliseconds(options.at("--transfer-ms"));
  return http;
}

void refuseAll(viewloom::Broadcaster& broadcaster) {
  for (const auto& display : broadcaster.displays("")) {
    broadcaster.refuse(display->id, viewloom::invalidField("quilt.size", "larger than the device"));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const auto options = readOptions(argc, argv);
  const viewloom::SteadyClock clock;
  viewloom::Metrics metrics;
  viewloom::StreamDirectory streams(clock, 8);
  viewloom::Broadcaster broadcaster(
      {.display_count_max = static_cast<uint32_t>(options.at("--displays"))});
  std::optional<viewloom::PaintedStream> painted;
  broadcaster.onDemandChange([&](const std::string& stream) {
    if (stream == "painted") painted->noteDemand();
  });
  painted.emplace("painted", streams, broadcaster,
                  std::chrono::milliseconds(options.at("--ms-per-megapixel")),
                  options.at("--flat") != 0);
  const auto silent = streams.claim("silent", "", [] {});
  const char* const token_file = std::getenv("PAINTED_TOKEN_FILE");
  viewloom::AccessControl access({.token_file = token_file == nullptr ? "" : token_file}, clock);
  viewloom::HttpOptions http_options = httpOptions(options);
  http_options.allowed_origins = allowedOrigins(argc, argv);
  viewloom::HttpServer server(std::move(http_options), streams, broadcaster, *painted, metrics,
                              clock, access, [] { return absl::OkStatus(); });
  std::cout << server.url() << std::endl;

  const int rate_hz = options.at("--rate-hz");
  std::jthread ticker([&](const std::stop_token& stop) {
    while (rate_hz > 0 && !stop.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1000 / rate_hz));
      painted->publishFrame();
    }
  });
  for (std::string line; std::getline(std::cin, line);) {
    if (line == "frame") painted->publishFrame();
    if (line == "refuse") refuseAll(broadcaster);
  }
  broadcaster.drain();
  server.drain();
  return 0;
}
