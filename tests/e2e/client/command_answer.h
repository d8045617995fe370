// SPDX-License-Identifier: Apache-2.0
// Output and exit code of a shell command.
#pragma once

#include <string>

namespace viewloom::test {

struct Answer {
  int exit_code = -1;  // -1 = a signal ended it
  std::string text;    // of both outputs
};

Answer answerTo(const std::string& command);

}  // namespace viewloom::test
