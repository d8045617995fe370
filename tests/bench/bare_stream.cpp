// SPDX-License-Identifier: Apache-2.0
#include "bench/bare_stream.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>

#include "messages/wire_message.h"
#include "viewloom/v1/display_service.grpc.pb.h"
#include "viewloom/v1/ingest_service.grpc.pb.h"

namespace viewloom::bench {
namespace {

constexpr size_t kMessage_bytes = size_t{1} << 20;

using RawReactor = grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>;

grpc::ByteBuffer shortMessage() {
  const grpc::Slice slice("done", 4);
  return {&slice, 1};
}

class TakingCall final : public RawReactor {
 public:
  TakingCall(uint64_t frame_bytes, Received received) : frame_bytes_(frame_bytes) {
    if (received == Received::kKept) kept_.emplace(frame_bytes);
    StartRead(&incoming_);
  }

  void OnReadDone(bool ok) override {
    if (!ok) {
      Finish(grpc::Status::OK);
      return;
    }
    if (kept_ && !kept_->add(incoming_)) {
      Finish({grpc::StatusCode::INTERNAL, "a message cannot be read"});
      return;
    }
    byte_count_ += incoming_.Length();
    incoming_.Clear();
    if (byte_count_ < frame_bytes_) {
      StartRead(&incoming_);
      return;
    }
    byte_count_ = 0;
    outgoing_ = shortMessage();
    StartWrite(&outgoing_);
  }
  void OnWriteDone(bool ok) override {
    if (ok) StartRead(&incoming_);
  }
  void OnDone() override { delete this; }

 private:
  const uint64_t frame_bytes_;
  std::optional<KeptMessages> kept_;  // none: they are dropped
  uint64_t byte_count_ = 0;
  grpc::ByteBuffer incoming_;
  grpc::ByteBuffer outgoing_;
};

class GivingCall final : public RawReactor {
 public:
  explicit GivingCall(SharedBytes frame) : frame_(std::move(frame)) { StartRead(&incoming_); }

  void OnReadDone(bool ok) override {
    const std::lock_guard lock(mutex_);
    if (!ok) {
      Finish(grpc::Status::OK);
      return;
    }
    owed_bytes_ += frame_->size();
    if (!writing_) writeNext();
    StartRead(&incoming_);
  }
  void OnWriteDone(bool ok) override {
    const std::lock_guard lock(mutex_);
    writing_ = false;
    if (ok && owed_bytes_ > 0) writeNext();
  }
  void OnDone() override { delete this; }

 private:
  void writeNext() {
    const uint64_t given_bytes = (frame_->size() - owed_bytes_ % frame_->size()) % frame_->size();
    const size_t size = std::min<uint64_t>(frame_->size() - given_bytes, kMessage_bytes);
    const grpc::Slice slice = sliceOf(frame_, given_bytes, size);
    outgoing_ = grpc::ByteBuffer(&slice, 1);
    owed_bytes_ -= size;
    writing_ = true;
    StartWrite(&outgoing_);
  }

  const SharedBytes frame_;
  std::mutex mutex_;
  uint64_t owed_bytes_ = 0;
  bool writing_ = false;
  grpc::ByteBuffer incoming_;
  grpc::ByteBuffer outgoing_;
};

}  // namespace

bool KeptMessages::add(const grpc::ByteBuffer& message) {
  if (byte_count_ == whole_bytes_) {
    messages_.clear();
    byte_count_ = 0;
  }
  std::vector<grpc::Slice> slices;
  if (!message.Dump(&slices).ok()) return false;
  std::string& copy = messages_.emplace_back();
  copy.reserve(message.Length());
  for (const grpc::Slice& slice : slices) {
    copy.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  }
  byte_count_ += copy.size();
  return true;
}

class BareServer::Taker final
    : public v1::IngestService::WithRawCallbackMethod_PublishFrames<v1::IngestService::Service> {
 public:
  Taker(uint64_t frame_bytes, Received received) : frame_bytes_(frame_bytes), received_(received) {}

 private:
  RawReactor* PublishFrames(grpc::CallbackServerContext* /*context*/) override {
    return new TakingCall(frame_bytes_, received_);
  }

  const uint64_t frame_bytes_;
  const Received received_;
};

class BareServer::Giver final
    : public v1::DisplayService::WithRawCallbackMethod_StreamAtlases<v1::DisplayService::Service> {
 public:
  explicit Giver(uint64_t frame_bytes) : frame_bytes_(frame_bytes) {}

 private:
  RawReactor* StreamAtlases(grpc::CallbackServerContext* /*context*/) override {
    std::call_once(made_,
                   [this] { frame_ = std::make_shared<const std::vector<uint8_t>>(frame_bytes_); });
    return new GivingCall(frame_);
  }

  const uint64_t frame_bytes_;
  std::once_flag made_;
  // All of it, as an atlas has it: a piece that is sent over and over again stays in the caches.
  SharedBytes frame_;
};

BareServer::BareServer(uint64_t frame_bytes, Received received)
    : taker_(std::make_unique<Taker>(frame_bytes, received)),
      giver_(std::make_unique<Giver>(frame_bytes)) {
  grpc::ServerBuilder builder;
  builder.SetMaxReceiveMessageSize(2 * int{kMessage_bytes});
  // Clients ask whether it is there while other ways are measured, as often as they like.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PING_STRIKES, 0);
  builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
  builder.RegisterService(taker_.get());
  builder.RegisterService(giver_.get());
  server_ = builder.BuildAndStart();
  if (server_ == nullptr || port_ == 0) throw std::runtime_error("cannot listen on the loopback");
}

BareServer::~BareServer() {
  server_->Shutdown(std::chrono::system_clock::now());
}

std::string BareServer::address() const {
  return "127.0.0.1:" + std::to_string(port_);
}

BareCall::BareCall(std::shared_ptr<grpc::Channel> channel, const std::string& method)
    : stub_(std::move(channel)) {
  call_ = stub_.PrepareCall(&context_, method, &queue_);
  call_->StartCall(this);
  await();
}

BareCall::~BareCall() {
  context_.TryCancel();
  queue_.Shutdown();
  void* tag = nullptr;
  bool ok = false;
  while (queue_.Next(&tag, &ok)) {
  }
}

void BareCall::write(const grpc::ByteBuffer& message) {
  call_->Write(message, this);
  await();
}

grpc::ByteBuffer BareCall::read() {
  grpc::ByteBuffer message;
  call_->Read(&message, this);
  await();
  return message;
}

void BareCall::await() {
  void* done = nullptr;
  bool ok = false;
  if (!queue_.Next(&done, &ok) || !ok || done != this) {
    throw std::runtime_error("the bare stream broke off");
  }
}

BareSender::BareSender(std::shared_ptr<grpc::Channel> channel)
    : call_(std::move(channel), "/viewloom.v1.IngestService/PublishFrames") {}

void BareSender::send(const std::vector<SharedBytes>& planes) {
  for (const SharedBytes& plane : planes) {
    for (size_t offset = 0; offset < plane->size(); offset += kMessage_bytes) {
      const grpc::Slice slice =
          sliceOf(plane, offset, std::min(kMessage_bytes, plane->size() - offset));
      call_.write(grpc::ByteBuffer(&slice, 1));
    }
  }
}

BareReceiver::BareReceiver(std::shared_ptr<grpc::Channel> channel, uint64_t frame_bytes, Take take)
    : frame_bytes_(frame_bytes),
      take_(std::move(take)),
      call_(std::move(channel), "/viewloom.v1.DisplayService/StreamAtlases") {}

void BareReceiver::receive(int frame_count) {
  for (int i = 0; i < frame_count; ++i) call_.write(shortMessage());
  uint64_t rest_bytes = uint64_t(frame_count) * frame_bytes_;
  while (rest_bytes > 0) {
    const grpc::ByteBuffer message = call_.read();
    rest_bytes -= message.Length();
    take_(message);
  }
}

}  // namespace viewloom::bench
