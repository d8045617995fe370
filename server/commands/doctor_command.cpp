// SPDX-License-Identifier: Apache-2.0
// viewloomd doctor: says what is well, what is not, and what to do about it.
#include <iostream>

#include "base/printable.h"
#include "base/processor_count.h"
#include "commands/command.h"
#include "commands/doctor_checks.h"
#include "usage/command_line.h"

namespace viewloom {
namespace {

constexpr int kExitProblem = 1;

const char* wordOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::kFine:
      return "ok      ";
    case Verdict::kAdvice:
      return "advice  ";
    case Verdict::kProblem:
      return "PROBLEM ";
  }
  return "";
}

int doctor(const Config& config) {
  bool has_problem = false;
  const auto tell = [&](const std::vector<Finding>& findings) {
    for (const Finding& finding : findings) {
      std::cout << wordOf(finding.verdict) << printable(finding.subject) << "  "
                << printable(finding.what, true) << "\n";
      if (finding.remedy.empty()) continue;
      std::cout << "        -> " << printable(finding.remedy) << "\n";
    }
    has_problem |= hasProblem(findings);
  };
  tell(checkHost(processors()));
  tell(checkContainment(config));
  tell(checkEngines(config));
  tell(checkVideo(config));
  tell(checkPorts(config));
  tell(checkAccess(config));
  tell(checkProtection(config));
  std::cout << (has_problem ? "viewloomd cannot run yet\n" : "viewloomd can run\n");
  return has_problem ? kExitProblem : 0;
}

}  // namespace

void addDoctorCommand(const usage::Command& app, RunCommand& chosen) {
  const usage::Command command = app.addCommand(
      "doctor",
      "Check the device, video, the ports and the host, and tell how to fix each problem");
  command.onChosen([&chosen] { chosen = doctor; });
}

}  // namespace viewloom
