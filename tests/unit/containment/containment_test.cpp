// SPDX-License-Identifier: Apache-2.0
#include "containment/containment.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <functional>

namespace viewloom::containment_test {
namespace {

void expectChild(const std::function<bool()>& holds, const char* on_standard_error = "") {
  EXPECT_EXIT(_exit(holds() ? 0 : 1), testing::ExitedWithCode(0), on_standard_error);
}

bool dumpsNoCore() {
  rlimit cores{};
  return getrlimit(RLIMIT_CORE, &cores) == 0 && cores.rlim_max == 0 && prctl(PR_GET_DUMPABLE) == 0;
}

bool canRead(const char* path) {
  const int file = open(path, O_RDONLY);
  if (file >= 0) close(file);
  return file >= 0;
}

TEST(Containment, forbidsCoreDumpsUnlessASettingAllowsThem) {
  expectChild([] {
    const Containment containment(ContainmentOptions{.is_enabled = false});
    return dumpsNoCore() && containment.description() == "no core dumps";
  });
  expectChild([] {
    const Containment containment({.is_enabled = false, .may_dump_core = true});
    return prctl(PR_GET_DUMPABLE) == 1 && containment.description() == "none";
  });
}

TEST(Containment, refusesNothingWhereItIsSwitchedOff) {
  expectChild(
      [] {
        Containment containment(ContainmentOptions{.is_enabled = false});
        containment.refuseCalls();
        return canRead("/etc/passwd") && socket(AF_UNIX, SOCK_DGRAM, 0) >= 0;
      },
      "containment is off \\(containment.enabled\\)");
}

TEST(Containment, saysWhatHolds) {
  expectChild(
      [] {
        Containment containment(ContainmentOptions{});
        containment.refuseCalls();
        const std::string held = containment.description();
        return held.find("no core dumps, no new privileges") != std::string::npos &&
               held.find("system calls (seccomp)") != std::string::npos &&
               socket(AF_UNIX, SOCK_DGRAM, 0) == -1;
      },
      "containment: no core dumps, no new privileges");
}

TEST(Containment, leavesLibrariesReadable) {
  expectChild([] {
    const Containment containment(ContainmentOptions{});
    const bool is_confined = containment.description().find("landlock") != std::string::npos;
    return canRead("/usr/share") && canRead("/proc/self/status") && canRead("/dev/null") &&
           canRead("/etc/shells") != is_confined;
  });
}

}  // namespace
}  // namespace viewloom::containment_test
