// SPDX-License-Identifier: Apache-2.0
#include "containment/containment.h"

#include <sys/prctl.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "absl/status/status.h"
#include "absl/strings/str_join.h"
#include "base/log.h"
#include "base/str_cat.h"
#include "containment/call_filter.h"
#include "containment/landlock.h"

namespace viewloom {
namespace {

// An image of the memory would hold pictures and secrets of users. Nor may other processes of the
// same user look into this one then.
void forbidCoreDumps() {
  constexpr rlimit kNone{.rlim_cur = 0, .rlim_max = 0};
  setrlimit(RLIMIT_CORE, &kNone);
  prctl(PR_SET_DUMPABLE, 0);
}

void makeFolders(const std::vector<FileGrant>& grants) {
  for (const FileGrant& grant : grants) {
    std::error_code error;  // without the folder nothing is kept there, as without containment
    if (grant.access == FileAccess::kKeep) std::filesystem::create_directories(grant.path, error);
  }
}

void append(std::vector<FileGrant>& all, const std::vector<FileGrant>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

Containment::Containment(const ContainmentOptions& options) : is_enabled_(options.is_enabled) {
  if (!options.may_dump_core) {
    forbidCoreDumps();
    parts_.emplace_back("no core dumps");
  }
  if (!is_enabled_) {
    log(LogLevel::kInfo, "containment is off (containment.enabled)");
    return;
  }
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0) parts_.emplace_back("no new privileges");
  confineFiles(options);
}

void Containment::confineFiles(const ContainmentOptions& options) {
  const int version = landlockVersion();
  if (version == 0) {
    log(LogLevel::kWarning,
        "containment: this kernel has no landlock, so the server can use all files of its user; "
        "Linux 5.13 and newer have it");
    return;
  }
  LandlockRules rules{.files = librariesGrants(processVariable),
                      .listen_ports = options.listen_ports};
  append(rules.files, driverCacheGrants(processVariable));
  append(rules.files, options.files);
  makeFolders(rules.files);
  const absl::Status confined = confineByLandlock(rules, version);
  if (!confined.ok()) {
    log(LogLevel::kWarning, "containment: files are not confined: ", confined.message());
    return;
  }
  parts_.push_back(strCat("files (landlock ", version, ")"));
}

void Containment::refuseCalls() {
  if (!is_enabled_) return;
  const absl::Status filtered = refuseOtherCalls();
  if (filtered.ok()) {
    parts_.emplace_back("system calls (seccomp)");
  } else {
    log(LogLevel::kWarning, "containment: system calls are not filtered: ", filtered.message());
  }
  log(LogLevel::kInfo, "containment: ", description());
}

std::string Containment::description() const {
  return parts_.empty() ? "none" : absl::StrJoin(parts_, ", ");
}

}  // namespace viewloom
