// SPDX-License-Identifier: Apache-2.0
// viewloomd as a process of its own.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace viewloom::test {

// Killed, if it still runs, with its owner. Thread-safety: none.
class ServerProcess {
 public:
  // Waits until it listens or has ended. `environment`: "NAME=value" beside what is inherited.
  explicit ServerProcess(const std::vector<std::string>& arguments,
                         std::vector<std::string> environment = {});
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  // From the line that says where it listens; empty when it ended without one.
  const std::string& grpcAddress() const { return grpc_address_; }
  void sendSignal(int signal) const;
  // Waits for the end; -1 when a signal ended it.
  int waitForExit();

 private:
  pid_t pid_ = -1;
  int output_ = -1;  // its standard output, read end
  std::string grpc_address_;
};

}  // namespace viewloom::test
