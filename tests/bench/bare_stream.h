// SPDX-License-Identifier: Apache-2.0
// The floor of any gRPC stream, in either direction: calls whose messages are dropped, or copied
// once.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <grpcpp/channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/server.h>

#include "base/byte_pool.h"

namespace viewloom::bench {

// The least that a receiver does with a frame or an atlas of so many bytes: it holds all of it in
// memory of its own.
class KeptMessages {
 public:
  explicit KeptMessages(uint64_t whole_bytes) : whole_bytes_(whole_bytes) {}

  // Copies the message. False: it cannot be read.
  bool add(const grpc::ByteBuffer& message);

 private:
  const uint64_t whole_bytes_;
  uint64_t byte_count_ = 0;
  std::vector<std::string> messages_;  // of the newest
};

// Fate of the messages that a BareServer receives.
enum class Received : uint8_t { kDropped, kKept };

// Takes calls of IngestService/PublishFrames, drops or keeps what comes, and answers every
// `frame_bytes` with one message. Takes calls of DisplayService/StreamAtlases, and answers every
// message with `frame_bytes` in messages of 1 MiB that share their bytes.
class BareServer {
 public:
  explicit BareServer(uint64_t frame_bytes, Received received = Received::kDropped);
  ~BareServer();

  std::string address() const;

 private:
  class Taker;
  class Giver;
  std::unique_ptr<Taker> taker_;
  std::unique_ptr<Giver> giver_;
  std::unique_ptr<grpc::Server> server_;
  int port_ = 0;
};

// A call of either method, one message at a time.
class BareCall {
 public:
  BareCall(std::shared_ptr<grpc::Channel> channel, const std::string& method);
  ~BareCall();
  BareCall(const BareCall&) = delete;
  BareCall& operator=(const BareCall&) = delete;

  // Return when the message has gone, or come. Throw std::runtime_error where the call broke off.
  void write(const grpc::ByteBuffer& message);
  grpc::ByteBuffer read();

 private:
  void await();

  grpc::GenericStub stub_;
  grpc::ClientContext context_;
  grpc::CompletionQueue queue_;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
};

// Sends bytes in messages of 1 MiB that share them, as fast as they go.
class BareSender {
 public:
  explicit BareSender(std::shared_ptr<grpc::Channel> channel);

  void send(const std::vector<SharedBytes>& planes);
  // The server has all of a frame that was sent.
  void awaitAnswer() { call_.read(); }

 private:
  BareCall call_;
};

// Asks for frames and gives their messages to `take` as they come.
class BareReceiver {
 public:
  using Take = std::function<void(const grpc::ByteBuffer&)>;
  BareReceiver(std::shared_ptr<grpc::Channel> channel, uint64_t frame_bytes, Take take);

  void receive(int frame_count);

 private:
  const uint64_t frame_bytes_;
  const Take take_;
  BareCall call_;
};

}  // namespace viewloom::bench
