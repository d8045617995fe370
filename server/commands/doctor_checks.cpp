// SPDX-License-Identifier: Apache-2.0
#include "commands/doctor_checks.h"

#include <netdb.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_join.h"
#include "access/key_set.h"
#include "access/token_list.h"
#include "access/watched_file.h"
#include "base/host_port.h"
#include "base/str_cat.h"
#include "containment/landlock.h"
#include "service.h"
#include "tls/exposure.h"
#include "tls/tls_material.h"

namespace viewloom {
namespace {

// A connection and a socket each; hundreds of viewers shall fit.
constexpr uint64_t kComfortableFileCount = 4096;
constexpr uint64_t kAccessFileBytesMax = uint64_t{8} << 20;

std::string whyNotBind(const addrinfo& candidate) {
  const int probe = socket(candidate.ai_family, candidate.ai_socktype, candidate.ai_protocol);
  if (probe < 0) return std::strerror(errno);
  // The servers do the same: a port whose last connections still linger counts as free.
  const int yes = 1;
  setsockopt(probe, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const bool is_free =
      bind(probe, candidate.ai_addr, candidate.ai_addrlen) == 0 && listen(probe, 1) == 0;
  std::string refusal = is_free ? "" : std::strerror(errno);
  close(probe);
  return refusal;
}

// A server replaces a socket file that is left over, but it cannot make its folder.
std::string whyNotUnix(const std::filesystem::path& path) {
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  return access(folder.c_str(), W_OK) == 0 ? "" : folder.string() + ": " + std::strerror(errno);
}

// Tries a listening address, "host:port", "[v6]:port" or "unix:path", without keeping it. Empty
// when it can be taken now; else why not.
std::string whyNotListen(const std::string& address) {
  constexpr char kUnix[] = "unix:";
  if (address.starts_with(kUnix)) return whyNotUnix(address.substr(sizeof kUnix - 1));
  const std::optional<HostPort> parsed = parseHostPort(address);
  if (!parsed || !parsed->port) return "it is not HOST:PORT";
  const addrinfo hints = {.ai_flags = AI_PASSIVE, .ai_socktype = SOCK_STREAM};
  addrinfo* found = nullptr;
  const int error =
      getaddrinfo(parsed->host.c_str(), std::to_string(*parsed->port).c_str(), &hints, &found);
  if (error != 0) return gai_strerror(error);
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, freeaddrinfo);
  return whyNotBind(*found);
}

std::vector<Finding> checkPort(const std::string& address, const std::string& setting) {
  std::vector<Finding> findings;
  const std::string refusal = whyNotListen(address);
  if (refusal.empty()) {
    findings.push_back({Verdict::kFine, "port", strCat(setting, " ", address, " is free"), ""});
  } else {
    findings.push_back(
        {Verdict::kProblem, "port", strCat(setting, " ", address, " cannot be taken: ", refusal),
         strCat("stop the program that uses it, or choose another address with --", setting)});
  }
  return findings;
}

Finding checkCertificate(const TlsConfig& tls) {
  const absl::StatusOr<TlsMaterialPtr> read =
      readTlsMaterial({.certificate = tls.certificate,
                       .key = tls.key,
                       .client_authorities = tls.client_ca,
                       .is_client_required = tls.client_required},
                      std::time(nullptr));
  if (read.ok()) {
    const Certificate& certificate = (*read)->certified_key.certificate;
    return {Verdict::kFine, "certificate",
            strCat("valid until ", dayText(certificate.endS()), ", for ",
                   absl::StrJoin(certificate.names(), ", ")),
            ""};
  }
  const std::string problem(read.status().message());
  const size_t remedy = std::min(problem.rfind("; "), problem.size());
  return {Verdict::kProblem, "certificate", problem.substr(0, remedy),
          remedy == problem.size() ? "correct the file" : problem.substr(remedy + 2)};
}

std::string coresText(const Processors& processors) {
  const uint32_t allowed_count = processors.allowed_count;
  std::string allowed = strCat(allowed_count, allowed_count == 1 ? " core" : " cores");
  if (!processors.isLimited()) return allowed;
  return strCat(processors.busyMax(), " of ", allowed, ", limited by a cgroup");
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

std::vector<Finding> checkAccess(const Config& config) {
  const AccessConfig& access = config.access;
  if (access.isOpen()) return {{Verdict::kFine, "access", "no token is needed", ""}};
  std::vector<Finding> findings;
  const auto check = [&](const std::string& file, const char* setting, const auto& parse) {
    if (file.empty()) return;
    const absl::StatusOr<std::string> text = readSmallFile(file, kAccessFileBytesMax);
    const absl::Status status = text.ok() ? parse(*text, file).status() : text.status();
    if (status.ok()) {
      findings.push_back({Verdict::kFine, "access", strCat(setting, " can be used"), ""});
    } else {
      findings.push_back({Verdict::kProblem, "access", std::string(status.message()),
                          strCat("correct the file, or name another with --", setting)});
    }
  };
  check(access.token_file, "access.token_file", TokenList::parse);
  check(access.jwks_file, "access.jwks_file", parseKeySet);
  if (!access.jwks_file.empty() && (access.audience.empty() || access.issuer.empty())) {
    findings.push_back({Verdict::kProblem, "access", "access.jwks_file needs audience and issuer",
                        "set access.audience and access.issuer"});
  }
  return findings;
}

std::vector<Finding> checkContainment(const Config& config) {
  const auto advice = [](std::string what, std::string remedy) {
    return std::vector<Finding>{
        {Verdict::kAdvice, "containment", std::move(what), std::move(remedy)}};
  };
  if (!config.containment.enabled) {
    return advice("is off: a fault in the server reaches all files of its user",
                  "set containment.enabled to true");
  }
  const int version = landlockVersion();
  if (version == 0) {
    return advice("this kernel has no landlock: the server can use all files of its user",
                  "use Linux 5.13 or newer, or a container");
  }
  return {{Verdict::kFine, "containment", strCat("files by landlock ", version), ""}};
}

std::vector<Finding> checkProtection(const Config& config) {
  std::vector<Finding> findings;
  const TlsConfig& tls = config.tls;
  if (!tls.certificate.empty() || !tls.key.empty() || !tls.client_ca.empty()) {
    findings.push_back(checkCertificate(tls));
  }
  const Exposure exposure = exposureOf(config);
  if (const std::optional<std::string> refusal = refusalToListen(exposure)) {
    const size_t remedy = refusal->find("; ");
    findings.push_back(
        {Verdict::kProblem, "network", refusal->substr(0, remedy), refusal->substr(remedy + 2)});
  } else if (reachOf(exposure) == ServerReach::kOpen) {
    findings.push_back({Verdict::kAdvice, "network",
                        "anybody on the network can reach the server, as --open allows",
                        "leave it in a network that you trust, or add tls.certificate and access "
                        "control"});
  }
  return findings;
}

std::vector<Finding> checkHost(const Processors& processors) {
  std::vector<Finding> findings;
  findings.push_back({Verdict::kFine, "host", coresText(processors), ""});
  rlimit files{};
  getrlimit(RLIMIT_NOFILE, &files);
  if (files.rlim_cur < kComfortableFileCount) {
    findings.push_back({Verdict::kAdvice, "host",
                        strCat("a process may open ", files.rlim_cur, " files and connections"),
                        strCat("for hundreds of viewers, raise the limit: ulimit -n ",
                               kComfortableFileCount, ", or LimitNOFILE of the service")});
  }
  return findings;
}

}  // namespace viewloom
