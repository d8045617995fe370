// SPDX-License-Identifier: Apache-2.0
// A viewloomd of our own, on free ports of the loopback.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <memory>
#include <string>

#include "load/process_usage.h"

namespace viewloom::load {

// Thread-safety: none but that of const methods.
class ServerProcess {
 public:
  // Waits until the server listens. Throws std::runtime_error when it does not.
  explicit ServerProcess(const std::string& program);
  // Kills what stop() has not ended.
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  const std::string& grpcAddress() const { return grpc_address_; }
  const std::string& httpUrl() const { return http_url_; }
  ProcessUsage usage() const { return usageOf(process_); }

  // SIGTERM, as an init system sends it; waits. Returns the exit code, or -1 when a signal ended
  // it.
  int stop();

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  pid_t process_ = -1;  // -1 = has ended
  std::unique_ptr<std::FILE, CloseFile> output_;
  std::string grpc_address_;
  std::string http_url_;
};

}  // namespace viewloom::load
