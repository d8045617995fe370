// SPDX-License-Identifier: Apache-2.0
// Calls that were begun, and say nothing.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/completion_queue.h>
#include <grpcpp/generic/generic_stub.h>

namespace viewloom {

// All on one channel. They end after a minute at the latest. Thread-safety: none.
class SilentCalls {
 public:
  explicit SilentCalls(const std::shared_ptr<grpc::Channel>& channel) : stub_(channel) {}
  // Cancels them.
  ~SilentCalls();
  SilentCalls(const SilentCalls&) = delete;
  SilentCalls& operator=(const SilentCalls&) = delete;

  // False if the call could not be begun.
  bool open(const std::string& method);
  // Says of the call opened last that nothing will come.
  void closeLast();
  // Waits for the end of the call opened last, to be asked once.
  grpc::Status endOfLast();

 private:
  struct Call {
    grpc::ClientContext context;
    std::unique_ptr<grpc::GenericClientAsyncReaderWriter> stream;
  };
  bool waitForNext();

  grpc::CompletionQueue queue_;
  grpc::GenericStub stub_;
  std::vector<std::unique_ptr<Call>> calls_;
};

}  // namespace viewloom
