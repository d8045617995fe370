// SPDX-License-Identifier: Apache-2.0
// viewloomd serve: runs the server.
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "base/clock.h"
#include "base/descriptors.h"
#include "base/heap.h"
#include "base/log.h"
#include "commands/command.h"
#include "commands/contained_serve.h"
#include "commands/reachable_addresses.h"
#include "containment/containment.h"
#include "service.h"
#include "usage/command_line.h"

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

std::string joined(const std::vector<std::string>& addresses, const char* before) {
  std::string text;
  for (const std::string& address : addresses)
    text += (text.empty() ? "" : ", ") + (before + address);
  return text;
}

// Says how other machines get here, and what keeps them out.
void sayReach(const std::string& grpc_address, const std::string& http_url, bool is_open,
              const InterfaceAddresses& interfaces) {
  constexpr std::string_view kScheme = "http://";
  const std::vector<std::string> grpc = reachableAddresses(grpc_address, interfaces);
  const std::vector<std::string> http =
      http_url.starts_with(kScheme)
          ? reachableAddresses(http_url.substr(kScheme.size()), interfaces)
          : std::vector<std::string>();
  if (!grpc.empty()) std::printf("Other machines: --server %s\n", joined(grpc, "").c_str());
  if (!http.empty()) std::printf("Page for other machines: %s\n", joined(http, "http://").c_str());
  if (!is_open && !(grpc.empty() && http.empty())) {
    std::printf("Access tokens decide who can publish and watch. Nothing is encrypted.\n");
  } else if (!grpc.empty()) {
    std::printf("There is no password: anybody who reaches %s can publish and watch streams.\n",
                grpc.front().c_str());
  } else if (!http.empty()) {
    std::printf("There is no password: anybody who reaches %s can watch all streams.\n",
                http.front().c_str());
  }
}

}  // namespace

int serve(const Config& config) {
  // gRPC's log is for its developers: what matters to users comes as an error.
  setenv("GRPC_VERBOSITY", "NONE", 0);
  keepFreedMemory();
  raiseDescriptorLimit();
  const sigset_t stop_signals = blockStopSignals();
  Containment containment(containmentOf(config));  // before the first thread
  const InterfaceAddresses interfaces = interfaceAddresses();
  const SteadyClock clock;
  std::atomic<bool> has_failed = false;
  const auto on_failure = [&has_failed](const std::exception& error) {
    has_failed = true;
    log(LogLevel::kError, "the server cannot go on: ", error.what());
    kill(getpid(), SIGTERM);  // wakes the wait below
  };
  const auto contain = [&containment] {
    containment.refuseCalls();
    return containment.description();
  };
  Service service(config, clock, on_failure, contain);
  std::printf("viewloomd listening grpc=%s http=%s\n", service.grpcAddress().c_str(),
              service.httpUrl().c_str());
  sayReach(service.grpcAddress(), service.httpUrl(), config.access.isOpen(), interfaces);
  std::fflush(stdout);

  int signal = 0;
  sigwait(&stop_signals, &signal);
  log(LogLevel::kInfo, "stopping: publishers and displays are told, and open calls end");
  service.drain();
  return has_failed ? kExitFailed : 0;
}

void addServeCommand(const usage::Command& app, RunCommand& chosen) {
  const usage::Command command =
      app.addCommand("serve", "Run the server until Ctrl-C or SIGTERM (default)");
  command.onChosen([&chosen] { chosen = serve; });
}

}  // namespace viewloom
