// SPDX-License-Identifier: Apache-2.0
#include "bench/bare_stream.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>

#include "messages/wire_message.h"
#include "viewloom/v1/ingest_service.grpc.pb.h"

namespace viewloom::bench {
namespace {

constexpr size_t kMessage_bytes = size_t{1} << 20;

class DroppingCall final : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer> {
 public:
  explicit DroppingCall(uint64_t answered_bytes) : answered_bytes_(answered_bytes) {
    StartRead(&incoming_);
  }

  void OnReadDone(bool ok) override {
    if (!ok) {
      Finish(grpc::Status::OK);
      return;
    }
    byte_count_ += incoming_.Length();
    incoming_.Clear();
    if (byte_count_ < answered_bytes_) {
      StartRead(&incoming_);
      return;
    }
    byte_count_ = 0;
    const grpc::Slice answer("done", 4);
    outgoing_ = grpc::ByteBuffer(&answer, 1);
    StartWrite(&outgoing_);
  }
  void OnWriteDone(bool ok) override {
    if (ok) StartRead(&incoming_);
  }
  void OnDone() override { delete this; }

 private:
  const uint64_t answered_bytes_;
  uint64_t byte_count_ = 0;
  grpc::ByteBuffer incoming_;
  grpc::ByteBuffer outgoing_;
};

}  // namespace

class BareServer::Service final
    : public v1::IngestService::WithRawCallbackMethod_PublishFrames<v1::IngestService::Service> {
 public:
  explicit Service(uint64_t answered_bytes) : answered_bytes_(answered_bytes) {}

 private:
  grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* PublishFrames(
      grpc::CallbackServerContext* /*context*/) override {
    return new DroppingCall(answered_bytes_);
  }

  const uint64_t answered_bytes_;
};

BareServer::BareServer(uint64_t answered_bytes)
    : service_(std::make_unique<Service>(answered_bytes)) {
  grpc::ServerBuilder builder;
  builder.SetMaxReceiveMessageSize(2 * int{kMessage_bytes});
  builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
  builder.RegisterService(service_.get());
  server_ = builder.BuildAndStart();
  if (server_ == nullptr || port_ == 0) throw std::runtime_error("cannot listen on the loopback");
}

BareServer::~BareServer() {
  server_->Shutdown(std::chrono::system_clock::now());
}

std::string BareServer::address() const {
  return "127.0.0.1:" + std::to_string(port_);
}

BareClient::BareClient(std::shared_ptr<grpc::Channel> channel) : stub_(std::move(channel)) {
  call_ = stub_.PrepareCall(&context_, "/viewloom.v1.IngestService/PublishFrames", &queue_);
  call_->StartCall(this);
  await(this);
}

BareClient::~BareClient() {
  context_.TryCancel();
  queue_.Shutdown();
  void* tag = nullptr;
  bool ok = false;
  while (queue_.Next(&tag, &ok)) {
  }
}

void BareClient::send(const std::vector<SharedBytes>& planes) {
  for (const SharedBytes& plane : planes) {
    for (size_t offset = 0; offset < plane->size(); offset += kMessage_bytes) {
      const grpc::Slice slice =
          sliceOf(plane, offset, std::min(kMessage_bytes, plane->size() - offset));
      call_->Write(grpc::ByteBuffer(&slice, 1), this);
      await(this);
    }
  }
  grpc::ByteBuffer answer;
  call_->Read(&answer, this);
  await(this);
}

void BareClient::await(void* tag) {
  void* done = nullptr;
  bool ok = false;
  if (!queue_.Next(&done, &ok) || !ok || done != tag) {
    throw std::runtime_error("the bare stream broke off");
  }
}

}  // namespace viewloom::bench
