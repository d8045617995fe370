// SPDX-License-Identifier: Apache-2.0
// Where a head tracker says the eyes are: lines of JSON from a file or a pipe.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "base/status.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom {

// {"time_ns": 8, "left": [-0.03, 0, 0.1], "right": [0.03, 0, 0.1]}: metres relative to the display,
// in any clock. An eye that is turned, or has a projection of its own, is a Camera of
// geometry.proto. May have predicted_display_time_ns; what else it has is for others. Errors name
// the key.
absl::StatusOr<v1::EyePoses> parseEyePoses(const std::string& line);

struct EyeFeedCallbacks {
  std::function<void(const v1::EyePoses& poses)> send;
  // A line is no pose: nothing is sent after it.
  std::function<void(const absl::Status& problem)> on_failure;
};

// A file is played by its own times from when it is started; a pipe gives poses as they come. After
// its end the last ones stay.
// Thread-safety: none; callbacks come from a thread of its own.
class EyeFeed {
 public:
  // "-": the standard input.
  static absl::StatusOr<std::unique_ptr<EyeFeed>> open(const std::string& file);
  // Breaks off.
  ~EyeFeed();
  EyeFeed(const EyeFeed&) = delete;
  EyeFeed& operator=(const EyeFeed&) = delete;

  // Once.
  void start(EyeFeedCallbacks callbacks);

 private:
  EyeFeed(std::string file, int descriptor);

  void run(const std::stop_token& stop);
  absl::StatusOr<std::optional<std::string>> nextLine(const std::stop_token& stop);
  void waitUntilDue(int64_t time_ns, const std::stop_token& stop);

  const std::string file_;
  const int descriptor_;
  const bool has_own_times_;
  EyeFeedCallbacks callbacks_;
  std::string unread_;  // bytes of lines to come
  uint64_t line_number_ = 0;
  // By the file's clock and by this machine's.
  struct Start {
    int64_t file_ns = 0;
    int64_t here_ns = 0;
  };
  std::optional<Start> first_;  // of its lines
  std::jthread thread_;         // last: it uses the rest
};

}  // namespace viewloom
