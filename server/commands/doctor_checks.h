// SPDX-License-Identifier: Apache-2.0
// What can stand in the way of a server on this machine, each with its remedy.
#pragma once

#include <string>
#include <vector>

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

// Vulkan devices: which there are, which lack what, which one would be taken, and its limits.
std::vector<Finding> checkDevices(const Config& config);
// Builds and traces a small scene on the device that would be taken.
std::vector<Finding> checkTrace(const Config& config);
// Whether each listening address can be taken, and whether it is for this machine alone.
std::vector<Finding> checkPorts(const Config& config);
// Cores, and how many connections the system lets a process have.
std::vector<Finding> checkHost();

}  // namespace viewloom
