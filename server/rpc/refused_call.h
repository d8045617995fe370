// SPDX-License-Identifier: Apache-2.0
// A call of somebody who may not call.
#pragma once

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include "rpc/status_to_grpc.h"

namespace viewloom {

// Ends at once, and takes no place among the open calls. The library owns it.
class RefusedCall final : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer> {
 public:
  explicit RefusedCall(const absl::Status& status) { Finish(statusToGrpc(status)); }
  void OnDone() override { delete this; }
};

}  // namespace viewloom
