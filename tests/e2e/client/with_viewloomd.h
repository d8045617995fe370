// SPDX-License-Identifier: Apache-2.0
// A real viewloomd under a test, with what clients of it need.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "e2e/server_process.h"
#include "lib/publisher.h"
#include "lib/watcher.h"

namespace viewloom::test {

inline constexpr int64_t kLong_ns = 120'000'000'000;  // only a failing test waits so long

// Two layers of 64x36 px.
WireFrame smallFrame(double time_s);

// 2x2 views of stream "s", with their mask.
v1::OpenDisplay smallQuilt(uint32_t count);

// The exit code of a shell command.
int runCommand(const std::string& command);

// Listens on a socket of its own, so that it can come back at the same address.
class WithViewloomd : public ::testing::Test {
 protected:
  WithViewloomd();
  ~WithViewloomd() override;

  void start();
  // By SIGTERM; returns the exit code.
  int stop();
  // Stream "s".
  std::unique_ptr<Publisher> publish(PublisherCallbacks callbacks = {},
                                     bool predicts_depth = false) const;
  std::unique_ptr<Watcher> watch(uint32_t count, std::function<void(const Atlas&)> on_atlas) const;
  std::unique_ptr<Watcher> watch(const v1::OpenDisplay& open,
                                 std::function<void(const Atlas&)> on_atlas) const;

  std::filesystem::path folder_;
  std::string address_;
  std::optional<ServerProcess> server_;
};

}  // namespace viewloom::test
