// SPDX-License-Identifier: Apache-2.0
#include "e2e/silent_calls.h"

#include "e2e/patience.h"

namespace viewloom {

SilentCalls::~SilentCalls() {
  for (const auto& call : calls_) call->context.TryCancel();
}

bool SilentCalls::waitForNext() {
  void* tag = nullptr;
  bool ok = false;
  return queue_.Next(&tag, &ok) && ok;
}

bool SilentCalls::open(const std::string& method) {
  Call& call = *calls_.emplace_back(std::make_unique<Call>());
  endAfterAMinute(call.context);
  call.stream = stub_.PrepareCall(&call.context, method, &queue_);
  call.stream->StartCall(nullptr);
  return waitForNext();
}

void SilentCalls::closeLast() {
  calls_.back()->stream->WritesDone(nullptr);
  waitForNext();
}

grpc::Status SilentCalls::endOfLast() {
  grpc::Status status;
  calls_.back()->stream->Finish(&status, nullptr);
  waitForNext();
  return status;
}

}  // namespace viewloom
