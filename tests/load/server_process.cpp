// SPDX-License-Identifier: Apache-2.0
#include "load/server_process.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <system_error>

namespace viewloom::load {
namespace {

void check(int error, const char* what) {
  if (error != 0) throw std::system_error(error, std::generic_category(), what);
}

// Starts the program with its standard output in a pipe; returns the end to read from.
std::FILE* start(const std::string& program, pid_t& process) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  posix_spawn_file_actions_t actions;
  check(posix_spawn_file_actions_init(&actions), "posix_spawn_file_actions_init");
  check(posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO), "adddup2");
  check(posix_spawn_file_actions_addclose(&actions, ends[0]), "addclose");
  check(posix_spawn_file_actions_addclose(&actions, ends[1]), "addclose");
  std::array<std::string, 6> words{program,       "serve",          "--grpc.address",
                                   "127.0.0.1:0", "--http.address", "127.0.0.1:0"};
  std::array<char*, 7> arguments{};
  for (size_t i = 0; i < words.size(); ++i) arguments[i] = words[i].data();
  const int error =
      posix_spawn(&process, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  check(error, program.c_str());
  return fdopen(ends[0], "r");
}

}  // namespace

ServerProcess::ServerProcess(const std::string& program) : output_(start(program, process_)) {
  std::array<char, 600> line{};
  std::array<char, 256> grpc_address{};
  std::array<char, 256> http_url{};
  const bool has_line = std::fgets(line.data(), static_cast<int>(line.size()), output_.get());
  if (!has_line || std::sscanf(line.data(), "viewloomd listening grpc=%255s http=%255s",
                               grpc_address.data(), http_url.data()) < 1) {
    stop();
    throw std::runtime_error(program + " did not start to listen");
  }
  grpc_address_ = grpc_address.data();
  http_url_ = http_url.data();
}

ServerProcess::~ServerProcess() {
  if (process_ == -1) return;
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

int ServerProcess::stop() {
  int status = 0;
  kill(process_, SIGTERM);
  waitpid(process_, &status, 0);
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace viewloom::load
