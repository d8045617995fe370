// SPDX-License-Identifier: Apache-2.0
// viewloomd serve: runs the server.
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/descriptors.h"
#include "base/heap.h"
#include "base/host_port.h"
#include "base/log.h"
#include "certificates/certificate.h"
#include "certificates/server_address.h"
#include "commands/command.h"
#include "commands/contained_serve.h"
#include "commands/reachable_addresses.h"
#include "containment/containment.h"
#include "engine_room.h"
#include "service.h"
#include "usage/command_line.h"
#include "web/qr_code.h"

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

std::string joined(const std::vector<std::string>& addresses, const std::string& before) {
  std::string text;
  for (const std::string& address : addresses)
    text += (text.empty() ? "" : ", ") + (before + address);
  return text;
}

// Addresses of other machines' view of the server.
struct Outside {
  std::vector<std::string> grpc;
  std::vector<std::string> http;
};

Outside outsideOf(const Service& service, const InterfaceAddresses& interfaces) {
  const std::string http_url = service.httpUrl();
  const size_t scheme_end = http_url.find("://");
  Outside outside;
  outside.grpc = reachableAddresses(parseServerAddress(service.grpcAddress()).target, interfaces);
  if (scheme_end != std::string::npos) {
    const std::string address = http_url.substr(scheme_end + 3);
    outside.http = reachableAddresses(address.substr(0, address.find('/')), interfaces);
  }
  return outside;
}

void sayCertificate(const Certificate& certificate) {
  std::printf("Certificate: SHA-256 fingerprint %s, valid until %s\n",
              certificate.fingerprint().text().c_str(), dayText(certificate.endS()).c_str());
  if (certificate.isSelfSigned()) {
    std::printf("Clients of this certificate: --fingerprint %s\n",
                certificate.fingerprint().text().c_str());
  }
}

// Says how other machines get here, and whether something keeps them out.
void sayReach(const Service& service, const Exposure& exposure,
              const InterfaceAddresses& interfaces) {
  const TlsMaterialPtr tls = service.tls();
  const std::string scheme = tls ? "https://" : "";
  const std::string page_scheme = tls ? "https://" : "http://";
  const auto [grpc, http] = outsideOf(service, interfaces);
  if (!grpc.empty()) std::printf("Other machines: --server %s\n", joined(grpc, scheme).c_str());
  if (!http.empty()) {
    std::printf("Page for other machines: %s\n", joined(http, page_scheme).c_str());
  }
  if (tls) sayCertificate(tls->certified_key.certificate);
  const bool is_open = reachOf(exposure) == ServerReach::kOpen;
  if (is_open && exposure.has_access_control) {
    std::printf("Nothing is encrypted: anybody on the way can read pictures and access tokens.\n");
  } else if (is_open && !grpc.empty()) {
    std::printf("There is no password: anybody who reaches %s can publish and watch streams.\n",
                grpc.front().c_str());
  } else if (is_open && !http.empty()) {
    std::printf("There is no password: anybody who reaches %s can watch all streams.\n",
                http.front().c_str());
  }
  // A local network, with phones in it.
  const bool is_local = tls && tls->certified_key.certificate.isSelfSigned() && !http.empty();
  if (is_local && isatty(STDOUT_FILENO) == 1) {
    std::fputs(qrCode(page_scheme + http.front() + "/").c_str(), stdout);
  }
}

int serveUntilStopped(const Config& config) {
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
              urlToOpen(service.httpUrl(), "localhost").c_str());
  sayReach(service, exposureOf(config), interfaces);
  std::fflush(stdout);

  int signal = 0;
  sigwait(&stop_signals, &signal);
  log(LogLevel::kInfo, "stopping: publishers and displays are told, and open calls end");
  service.drain();
  return has_failed ? kExitFailed : 0;
}

}  // namespace

int serve(const Config& config) try {
  return serveUntilStopped(config);
} catch (const DeviceFailure& failure) {
  log(LogLevel::kError, "the server cannot go on: ", failure.what());
  return kExitFailed;
}

void addServeCommand(const usage::Command& app, RunCommand& chosen) {
  const usage::Command command =
      app.addCommand("serve", "Run the server until Ctrl-C or SIGTERM (default)");
  command.onChosen([&chosen] { chosen = serve; });
}

}  // namespace viewloom
