// SPDX-License-Identifier: Apache-2.0
#include "e2e/client/with_viewloomd.h"

#include <sys/wait.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <utility>
#include <vector>

#include "lib/channel.h"
#include "synthetic/synthetic_wire_frame.h"

namespace viewloom::test {
namespace {

constexpr BackoffOptions kQuick{.first_ns = 10'000'000, .max_ns = 200'000'000, .factor = 2};

}  // namespace

WireFrame smallFrame(double time_s) {
  return syntheticWireFrame({.size_px = {64, 36}, .layer_count = 2, .time_s = time_s, .camera = {}},
                            1);
}

v1::OpenDisplay smallQuilt(uint32_t count) {
  v1::OpenDisplay open;
  open.set_stream("s");
  v1::QuiltDisplay& quilt = *open.mutable_display()->mutable_quilt();
  quilt.set_columns(2);
  quilt.set_rows(2);
  quilt.mutable_size()->set_width(96);
  quilt.mutable_size()->set_height(64);
  open.mutable_encoding()->set_with_mask(true);
  open.set_count(count);
  open.set_wait_for_stream(true);
  return open;
}

int runCommand(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

WithViewloomd::WithViewloomd() {
  std::string pattern = (std::filesystem::temp_directory_path() / "viewloom_XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  folder_ = pattern;
  address_ = "unix:" + (folder_ / "server").string();
  start();
}

WithViewloomd::~WithViewloomd() {
  server_.reset();
  std::filesystem::remove_all(folder_);
}

void WithViewloomd::start() {
  server_.emplace(
      std::vector<std::string>{"serve", "--grpc.address", address_, "--http.enabled", "false"});
}

int WithViewloomd::stop() {
  server_->sendSignal(SIGTERM);
  return server_->waitForExit();
}

std::unique_ptr<Publisher> WithViewloomd::publish(PublisherCallbacks callbacks,
                                                  bool predicts_depth) const {
  return std::make_unique<Publisher>(
      makeChannel(address_),
      PublisherOptions{
          .stream = "s", .session_id = {}, .predicts_depth = predicts_depth, .backoff = kQuick},
      std::move(callbacks));
}

std::unique_ptr<Watcher> WithViewloomd::watch(uint32_t count,
                                              std::function<void(const Atlas&)> on_atlas) const {
  return watch(smallQuilt(count), std::move(on_atlas));
}

std::unique_ptr<Watcher> WithViewloomd::watch(const v1::OpenDisplay& open,
                                              std::function<void(const Atlas&)> on_atlas) const {
  const WatcherCallbacks callbacks{
      .on_layout = {}, .on_atlas = std::move(on_atlas), .on_connection = {}};
  return std::make_unique<Watcher>(makeChannel(address_), open, callbacks, kQuick);
}

}  // namespace viewloom::test
