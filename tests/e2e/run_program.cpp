// SPDX-License-Identifier: Apache-2.0
#include "e2e/run_program.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace viewloom::test {
namespace {

std::string textOf(const std::filesystem::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  std::filesystem::remove(path);
  return text.str();
}

FinishedRun run(const std::string& program, const std::string& arguments) {
  const std::filesystem::path base =
      std::filesystem::temp_directory_path() / ("viewloom_run_" + std::to_string(getpid()));
  const std::string out = base.string() + ".out";
  const std::string err = base.string() + ".err";
  const std::string command =
      "'" + program + "' " + arguments + " > '" + out + "' 2> '" + err + "'";
  const int status = std::system(command.c_str());
  return {.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
          .output = textOf(out),
          .errors = textOf(err)};
}

}  // namespace

FinishedRun runViewloomd(const std::string& arguments) {
  return run(VIEWLOOMD_PATH, arguments);
}

FinishedRun runViewloom(const std::string& arguments) {
  return run(VIEWLOOM_PATH, arguments);
}

}  // namespace viewloom::test
