// SPDX-License-Identifier: Apache-2.0
#include "commands/serve.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>

#include "base/clock.h"
#include "base/log.h"
#include "commands/command.h"
#include "service.h"

namespace viewloom {
namespace {

constexpr int kExitFailed = 3;

sigset_t blockStopSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

}  // namespace

int serve(const Config& config) {
  const sigset_t stop_signals = blockStopSignals();
  const SteadyClock clock;
  std::atomic<bool> has_failed = false;
  Service service(config, clock, [&](const std::exception& error) {
    has_failed = true;
    log(LogLevel::kError, "the server cannot go on: ", error.what());
    kill(getpid(), SIGTERM);  // wakes the wait below
  });
  std::printf("viewloomd listening grpc=%s http=%s\n", service.grpcAddress().c_str(),
              service.httpUrl().c_str());
  std::fflush(stdout);

  int signal = 0;
  sigwait(&stop_signals, &signal);
  log(LogLevel::kInfo, "draining");
  service.drain();
  return has_failed ? kExitFailed : 0;
}

void addServeCommand(CLI::App& app, Command& chosen) {
  CLI::App* const command = app.add_subcommand("serve", "Runs the server (default)");
  command->fallthrough();
  command->callback([&chosen] { chosen = serve; });
}

}  // namespace viewloom
