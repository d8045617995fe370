// SPDX-License-Identifier: Apache-2.0
// Takes rights from this process that a server does not need, so that a fault in it hurts little
// else: files (landlock), system calls (seccomp), new rights, images of its memory.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "containment/file_grants.h"

namespace viewloom {

struct ContainmentOptions {
  bool is_enabled = true;
  bool may_dump_core = false;
  std::vector<FileGrant> files;        // beside those of libraries and drivers
  std::vector<uint16_t> listen_ports;  // TCP; 0 = any free one
};

// Skips measures that the kernel does not offer, with a line in the log. Nothing is given back when
// the object dies. Thread-safety: none.
class Containment {
 public:
  // First half: files, new rights, core dumps. Holds for the calling thread and those that it
  // starts later, so it comes before any other thread.
  explicit Containment(const ContainmentOptions& options);

  // Second half: system calls, of all threads. Comes when devices are open, and before anybody can
  // connect.
  void refuseCalls();

  // The measures that hold, in words: "files (landlock 7), system calls (seccomp), no core dumps";
  // "none".
  std::string description() const;

 private:
  void confineFiles(const ContainmentOptions& options);

  bool is_enabled_;
  std::vector<std::string> parts_;
};

}  // namespace viewloom
