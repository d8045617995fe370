// SPDX-License-Identifier: Apache-2.0
#include "load/load_run.h"

#include <unistd.h>

#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>

#include "lib/catalog.h"
#include "lib/channel.h"
#include "load/server_metrics.h"
#include "load/server_process.h"
#include "load/synthetic_loop.h"

namespace viewloom::load {
namespace {

constexpr uint32_t kLoopFrames = 8;

std::string streamName(uint32_t index) {
  return "load-" + std::to_string(index);
}

// The address of the web server, as the server itself says.
std::string httpUrlOf(const std::shared_ptr<grpc::Channel>& channel) {
  const absl::StatusOr<v1::GetServerInfoResponse> info = Catalog(channel).getServerInfo();
  if (!info.ok()) throw std::runtime_error(info.status().ToString());
  const std::string& address = info->http_address();
  if (address.empty() || address.rfind("http://", 0) == 0) return address;
  return "http://" + address + "/";
}

void watchOver(const std::optional<ServerProcess>& server, uint32_t seconds, LoadResult& result) {
  const auto begin = std::chrono::steady_clock::now();
  for (uint32_t second = 1; second <= seconds; ++second) {
    std::this_thread::sleep_until(begin + std::chrono::seconds(second));
    if (server) result.server_usage.push_back(server->usage());
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  result.seconds = elapsed.count();
}

}  // namespace

LoadResult runLoad(const LoadOptions& options) {
  std::optional<ServerProcess> server;
  if (options.server.empty()) server.emplace(options.viewloomd);
  const std::string address = server ? server->grpcAddress() : options.server;
  const std::string http_url = httpUrlOf(makeChannel(address));
  const std::vector<WireFrame> frames =
      makeSyntheticLoop(options.size_px, options.layer_count, kLoopFrames);
  const int64_t cpu_before_ns = usageOf(getpid()).cpu_ns;

  LoadResult result;
  std::vector<std::unique_ptr<LoadPublisher>> publishers;
  for (uint32_t i = 0; i < options.publishers; ++i) {
    publishers.push_back(std::make_unique<LoadPublisher>(makeChannel(address), streamName(i),
                                                         frames, options.rate_hz));
  }
  std::vector<std::unique_ptr<LoadDisplay>> displays;
  for (uint32_t i = 0; i < options.displays; ++i) {
    const bool is_slow = i >= options.displays - options.slow_displays;
    const v1::OpenDisplay open = mixedDisplay(i, streamName(i % options.publishers));
    displays.push_back(std::make_unique<LoadDisplay>(makeChannel(address), open, is_slow));
  }
  watchOver(server, options.seconds, result);

  for (const auto& publisher : publishers) result.publishers.push_back(publisher->finish());
  for (const auto& display : displays) result.displays.push_back(display->finish());
  if (!http_url.empty()) result.metrics = readServerMetrics(http_url);
  result.client_usage = usageOf(getpid());
  result.client_usage.cpu_ns -= cpu_before_ns;
  if (server) result.server_exit_code = server->stop();
  return result;
}

}  // namespace viewloom::load
