// SPDX-License-Identifier: Apache-2.0
#include "e2e/server_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>

namespace viewloom::test {
namespace {

// Reads to the end of the line, or of the output.
std::string readLine(int descriptor) {
  std::string line;
  char letter = 0;
  while (read(descriptor, &letter, 1) == 1 && letter != '\n') line += letter;
  return line;
}

std::string valueOf(const std::string& line, const std::string& key) {
  const size_t at = line.find(" " + key + "=");
  if (at == std::string::npos) return "";
  const size_t begin = at + key.size() + 2;
  return line.substr(begin, line.find(' ', begin) - begin);
}

// Pointers for exec, ended by a null pointer. The first of two equal variables wins.
std::vector<char*> pointersTo(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace

ServerProcess::ServerProcess(const std::vector<std::string>& arguments,
                             std::vector<std::string> environment) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  output_ = ends[0];
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);

  std::vector<std::string> words{VIEWLOOMD_PATH};
  words.insert(words.end(), arguments.begin(), arguments.end());
  for (char** inherited = environ; *inherited != nullptr; ++inherited) {
    environment.emplace_back(*inherited);
  }
  const int error = posix_spawn(&pid_, VIEWLOOMD_PATH, &actions, nullptr, pointersTo(words).data(),
                                pointersTo(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (error != 0) throw std::runtime_error("cannot start " VIEWLOOMD_PATH);
  grpc_address_ = valueOf(readLine(output_), "grpc");
}

ServerProcess::~ServerProcess() {
  if (pid_ > 0) {
    sendSignal(SIGKILL);
    waitForExit();
  }
  close(output_);
}

void ServerProcess::sendSignal(int signal) const {
  kill(pid_, signal);
}

int ServerProcess::waitForExit() {
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace viewloom::test
