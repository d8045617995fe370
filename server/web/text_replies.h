// SPDX-License-Identifier: Apache-2.0
// Text messages that wait for one WebSocket client: of each kind, the newest.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

namespace viewloom {

// Thread-safety: none.
class TextReplies {
 public:
  // A refusal, as errorJson() gives it.
  void error(std::string json) { error_ = std::move(json); }
  void pong(uint64_t number) { pong_ = number; }
  // The client's time of its own clock; the server's monotonic clock.
  void clock(int64_t client_time_ns, int64_t received_ns) {
    clock_ = Probe{.client_time_ns = client_time_ns, .received_ns = received_ns};
  }

  // The next to send; none = nothing waits.
  std::optional<std::string> take(int64_t now_ns) {
    if (error_) return std::exchange(error_, std::nullopt);
    if (pong_) return nlohmann::json{{"pong", *std::exchange(pong_, std::nullopt)}}.dump();
    if (!clock_) return std::nullopt;
    const Probe probe = *std::exchange(clock_, std::nullopt);
    return nlohmann::json{{"clock",
                           {{"client_time_ns", std::to_string(probe.client_time_ns)},
                            {"server_received_ns", std::to_string(probe.received_ns)},
                            {"server_sent_ns", std::to_string(now_ns)}}}}
        .dump();
  }

 private:
  struct Probe {
    int64_t client_time_ns = 0;
    int64_t received_ns = 0;
  };

  std::optional<std::string> error_;
  std::optional<uint64_t> pong_;
  std::optional<Probe> clock_;
};

}  // namespace viewloom
