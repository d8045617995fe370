// SPDX-License-Identifier: Apache-2.0
#include "e2e/raw_call.h"

#include <grpcpp/client_context.h>
#include <grpcpp/completion_queue.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/byte_buffer.h>

#include "e2e/patience.h"

namespace viewloom {
namespace {

// Waits for the one operation that is under way.
bool nextOk(grpc::CompletionQueue& queue) {
  void* tag = nullptr;
  bool ok = false;
  return queue.Next(&tag, &ok) && ok;
}

std::string textOf(const grpc::ByteBuffer& bytes) {
  std::vector<grpc::Slice> slices;
  std::string text;
  if (!bytes.Dump(&slices).ok()) return text;
  for (const grpc::Slice& slice : slices) text.append(slice.begin(), slice.end());
  return text;
}

}  // namespace

RawReply converse(const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
                  const std::string& message) {
  RawReply reply;
  grpc::CompletionQueue queue;
  grpc::ClientContext context;
  endAfterAMinute(context);
  grpc::GenericStub stub(channel);
  const auto call = stub.PrepareCall(&context, method, &queue);
  call->StartCall(nullptr);
  if (nextOk(queue)) {
    const grpc::Slice slice(message);
    call->WriteLast(grpc::ByteBuffer(&slice, 1), {}, nullptr);
    nextOk(queue);
    grpc::ByteBuffer received;
    for (call->Read(&received, nullptr); nextOk(queue); call->Read(&received, nullptr)) {
      reply.messages.push_back(textOf(received));
    }
  }
  call->Finish(&reply.status, nullptr);
  nextOk(queue);
  return reply;
}

}  // namespace viewloom
