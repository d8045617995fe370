// SPDX-License-Identifier: Apache-2.0
// Runs a program to its end, as a person would type it.
#pragma once

#include <string>

namespace viewloom::test {

struct FinishedRun {
  int exit_code = -1;  // -1 = it did not end by itself
  std::string output;  // standard output
  std::string errors;  // standard error
};

// `arguments` as for a shell.
FinishedRun runViewloomd(const std::string& arguments);
FinishedRun runViewloom(const std::string& arguments);

}  // namespace viewloom::test
