// SPDX-License-Identifier: Apache-2.0
// Work in a process of its own, whose CPU time can be asked for while it goes on.
#pragma once

#include <sys/types.h>

#include <functional>
#include <memory>
#include <string>

namespace viewloom::bench {

// CPU time of this process so far, of all its threads.
double cpuTime_s();

// Forks, so begin it before this process has threads. Thread-safety: none.
class MeasuredProcess {
 public:
  // The parts of the work, which live until the process ends, and where others find it.
  struct Running {
    std::shared_ptr<void> parts;
    std::string address;
  };
  explicit MeasuredProcess(const std::function<Running()>& begin);
  // Ends the process.
  ~MeasuredProcess();
  MeasuredProcess(const MeasuredProcess&) = delete;
  MeasuredProcess& operator=(const MeasuredProcess&) = delete;

  const std::string& address() const { return address_; }
  // Its CPU time so far. Throws std::runtime_error where it has ended.
  double cpuTime_s() const;

 private:
  pid_t child_ = 0;
  int socket_ = -1;
  std::string address_;
};

}  // namespace viewloom::bench
