// SPDX-License-Identifier: Apache-2.0
// Asks the server whether it had better interlace for a panel, or leave that to this machine.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "base/status.h"
#include "lib/channel.h"
#include "lib/retry_loop.h"
#include "show/show_settings.h"
#include "viewloom/v1/catalog_service.pb.h"

namespace viewloom::show {

struct SuitedMode {
  ShowMode mode = ShowMode::kNative;
  std::string reason;  // a line for the user
};

// kWeave where the server traces on a CPU, else kNative, also where it does not say.
SuitedMode suitedMode(const absl::StatusOr<v1::GetServerInfoResponse>& info);

// Asks again for as long as nobody listens.
// Thread-safety: all methods may be called from any thread, but the destructor from one only.
class ModeQuestion {
 public:
  // Both are called from a thread of its own; on_answer once.
  ModeQuestion(std::shared_ptr<grpc::Channel> channel, OnConnection on_connection,
               std::function<void()> on_answer);
  // None until the server has answered.
  std::optional<SuitedMode> answer() const;

 private:
  void ask(const std::stop_token& stop, const std::shared_ptr<grpc::Channel>& channel,
           const OnConnection& on_connection);

  mutable std::mutex mutex_;
  std::optional<SuitedMode> answer_;
  std::jthread thread_;  // last: joins before what it uses goes
};

}  // namespace viewloom::show
