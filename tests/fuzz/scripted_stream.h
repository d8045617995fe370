// SPDX-License-Identifier: Apache-2.0
// A bidirectional call without a network: a script says when messages come, when writes are
// through, and how it ends.
#pragma once

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "base/check.h"
#include "rpc/bidi_call.h"

namespace viewloom {

// Keeps the promises of gRPC, and checks those of the call: one read, one write and one end at a
// time, and none after the end. Thread-safety: the call may use it from any thread; other methods
// are for one thread.
class ScriptedStream final
    : public grpc::ServerCallbackReaderWriter<grpc::ByteBuffer, grpc::ByteBuffer> {
 public:
  // The call is opened already, or will be.
  explicit ScriptedStream(const std::shared_ptr<BidiCall>& call) : call_(call.get()) {
    BindReactor(call_);
  }

  bool hasEnded() const { return is_done_; }
  // How the call wants to end, once it does.
  std::optional<grpc::Status> finished() {
    std::lock_guard lock(mutex_);
    return finished_;
  }

  // The client sends a message. Nothing happens unless the call reads.
  void give(grpc::ByteBuffer message) {
    if (grpc::ByteBuffer* const place = takeRead()) {
      place->Swap(&message);
      call_->OnReadDone(true);
    }
  }

  // The client sends no more, which the call hears once.
  void halfClose() {
    if (takeRead() != nullptr) call_->OnReadDone(false);
  }

  // The message that the call writes, if any.
  std::optional<grpc::ByteBuffer> written() {
    std::lock_guard lock(mutex_);
    if (writing_ == nullptr) return std::nullopt;
    return *writing_;
  }

  // The message is through, or lost. Nothing happens unless the call writes.
  void finishWrite(bool ok) {
    {
      std::lock_guard lock(mutex_);
      if (std::exchange(writing_, nullptr) == nullptr) return;
    }
    call_->OnWriteDone(ok);
  }

  void cancel() {
    if (is_done_ || std::exchange(is_cancelled_, true)) return;
    call_->OnCancel();
  }

  // Ends the call if it has nothing under way and wants to end. gRPC then lets go of it.
  void settle() {
    {
      std::lock_guard lock(mutex_);
      if (is_done_ || !finished_ || reading_ != nullptr || writing_ != nullptr) return;
      is_done_ = true;
    }
    call_->OnDone();
  }

  void Read(grpc::ByteBuffer* message) override {
    std::lock_guard lock(mutex_);
    VIEWLOOM_CHECK(reading_ == nullptr && !finished_);
    reading_ = message;
  }
  void Write(const grpc::ByteBuffer* message, grpc::WriteOptions) override {
    std::lock_guard lock(mutex_);
    VIEWLOOM_CHECK(writing_ == nullptr && !finished_);
    writing_ = message;
  }
  void Finish(grpc::Status status) override {
    std::lock_guard lock(mutex_);
    VIEWLOOM_CHECK(!finished_);
    VIEWLOOM_CHECK(status.ok() || !status.error_message().empty());
    finished_ = std::move(status);
  }
  void SendInitialMetadata() override { VIEWLOOM_CHECK(false); }
  void WriteAndFinish(const grpc::ByteBuffer*, grpc::WriteOptions, grpc::Status) override {
    VIEWLOOM_CHECK(false);
  }

 private:
  grpc::internal::ServerReactor* reactor() override { return call_; }
  void CallOnDone() override {}

  grpc::ByteBuffer* takeRead() {
    std::lock_guard lock(mutex_);
    return std::exchange(reading_, nullptr);
  }

  BidiCall* const call_;  // lives until OnDone
  bool is_cancelled_ = false;
  bool is_done_ = false;
  std::mutex mutex_;
  grpc::ByteBuffer* reading_ = nullptr;
  const grpc::ByteBuffer* writing_ = nullptr;
  std::optional<grpc::Status> finished_;
};

}  // namespace viewloom
