// SPDX-License-Identifier: Apache-2.0
#include "e2e/run_viewloomd.h"

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

}  // namespace

FinishedRun runViewloomd(const std::string& arguments) {
  const std::filesystem::path base =
      std::filesystem::temp_directory_path() / ("viewloomd_" + std::to_string(getpid()));
  const std::string out = base.string() + ".out";
  const std::string err = base.string() + ".err";
  const std::string command =
      "'" VIEWLOOMD_PATH "' " + arguments + " > '" + out + "' 2> '" + err + "'";
  const int status = std::system(command.c_str());
  return {.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
          .output = textOf(out),
          .errors = textOf(err)};
}

}  // namespace viewloom::test
