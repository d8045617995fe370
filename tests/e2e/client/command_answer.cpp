// SPDX-License-Identifier: Apache-2.0
#include "e2e/client/command_answer.h"

#include <sys/wait.h>

#include <array>
#include <cstdio>

namespace viewloom::test {

Answer answerTo(const std::string& command) {
  std::FILE* const pipe = popen(("exec 2>&1; " + command).c_str(), "r");
  Answer answer;
  std::array<char, 4096> bytes{};
  while (const size_t size = fread(bytes.data(), 1, bytes.size(), pipe)) {
    answer.text.append(bytes.data(), size);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) answer.exit_code = WEXITSTATUS(status);
  return answer;
}

}  // namespace viewloom::test
