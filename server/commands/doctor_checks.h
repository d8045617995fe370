// SPDX-License-Identifier: Apache-2.0
// Checks for obstacles to a server on this machine, each with its remedy.
#pragma once

#include <string>
#include <vector>

#include "base/processor_count.h"
#include "config/config.h"

namespace viewloom {

enum class Verdict : uint8_t {
  kFine,
  kAdvice,  // runs, but not as well or as safely as it could
  kProblem  // does not run
};

struct Finding {
  Verdict verdict = Verdict::kFine;
  std::string subject;  // "device", "port"
  std::string what;     // one sentence
  std::string remedy;   // what to do about it; empty when fine
};

bool hasProblem(const std::vector<Finding>& findings);

// Whether atlases can be made: devices, and a small scene. A server without engines says so.
std::vector<Finding> checkEngines(const Config& config);
// Each video encoder, tried on a few pictures, and which one a server would use.
std::vector<Finding> checkVideo(const Config& config);
// Whether each listening address can be taken.
std::vector<Finding> checkPorts(const Config& config);
// Whether the files of access.* can be used.
std::vector<Finding> checkAccess(const Config& config);
// Whether this kernel can refuse files and system calls that a server does not need.
std::vector<Finding> checkContainment(const Config& config);
// Certificate and key, and whether the server may listen where it would.
std::vector<Finding> checkProtection(const Config& config);
// Cores, and how many connections the system lets a process have.
std::vector<Finding> checkHost(const Processors& processors);

}  // namespace viewloom
