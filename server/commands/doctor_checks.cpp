// SPDX-License-Identifier: Apache-2.0
#include "commands/doctor_checks.h"

#include <sys/resource.h>

#include <algorithm>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "base/host_port.h"
#include "base/str_cat.h"
#include "commands/listen_probe.h"

namespace viewloom {
namespace {

// A connection and a socket each; hundreds of viewers shall fit.
constexpr uint64_t kComfortableFileCount = 4096;

bool isForThisMachine(const std::string& address) {
  const std::optional<HostPort> parsed = parseHostPort(address);
  return address.starts_with("unix:") || (parsed && isLoopbackHost(parsed->host));
}

std::vector<Finding> checkPort(const std::string& address, const std::string& setting) {
  std::vector<Finding> findings;
  const std::string refusal = whyNotListen(address);
  if (refusal.empty()) {
    findings.push_back({Verdict::kFine, "port", strCat(setting, " ", address, " is free"), ""});
  } else {
    findings.push_back(
        {Verdict::kProblem, "port", strCat(setting, " ", address, " cannot be taken: ", refusal),
         strCat("stop what listens there, or choose another address with --", setting)});
  }
  if (!isForThisMachine(address)) {
    findings.push_back({Verdict::kAdvice, "port",
                        strCat(setting, " ", address,
                               " is open to the network, without encryption "
                               "or passwords"),
                        "use it in a lab you trust, or listen on 127.0.0.1"});
  }
  return findings;
}

}  // namespace

bool hasProblem(const std::vector<Finding>& findings) {
  return std::ranges::any_of(
      findings, [](const Finding& finding) { return finding.verdict == Verdict::kProblem; });
}

std::vector<Finding> checkPorts(const Config& config) {
  std::vector<Finding> findings = checkPort(config.grpc.address, "grpc.address");
  if (!config.http.enabled) return findings;
  for (Finding& finding : checkPort(config.http.address, "http.address")) {
    findings.push_back(std::move(finding));
  }
  return findings;
}

std::vector<Finding> checkHost() {
  std::vector<Finding> findings;
  const unsigned cores = std::thread::hardware_concurrency();
  findings.push_back({Verdict::kFine, "host", strCat(cores, cores == 1 ? " core" : " cores"), ""});
  rlimit files{};
  getrlimit(RLIMIT_NOFILE, &files);
  if (files.rlim_cur < kComfortableFileCount) {
    findings.push_back({Verdict::kAdvice, "host",
                        strCat("a process may hold ", files.rlim_cur, " files and connections"),
                        strCat("for hundreds of viewers raise it: ulimit -n ",
                               kComfortableFileCount, ", or LimitNOFILE of the service")});
  }
  return findings;
}

}  // namespace viewloom
