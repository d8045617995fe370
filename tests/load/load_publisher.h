// SPDX-License-Identifier: Apache-2.0
// A publisher that sends at a steady rate and keeps book of the reports.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "lib/publisher.h"

namespace viewloom::load {

struct PublisherBook {
  std::string stream;
  PublisherCounts counts;
  uint64_t traced = 0;
  uint64_t built_without_display = 0;
  uint64_t reported_frames = 0;  // numbers with at least one report
  uint64_t repeated_reports = 0;
  absl::Status end;
};

// Thread-safety: none but the publisher's own; one owner.
class LoadPublisher {
 public:
  // Begins at once. The frames are sent round and round.
  LoadPublisher(const std::shared_ptr<grpc::Channel>& channel, std::string stream,
                std::vector<WireFrame> frames, double rate_hz);
  // Sends no more, waits for the reports that are due.
  PublisherBook finish();

 private:
  void note(const v1::FrameReport& report);
  void offerFrames(const std::stop_token& stop, double rate_hz);

  std::vector<WireFrame> frames_;
  std::mutex mutex_;
  PublisherBook book_;
  std::map<uint64_t, uint32_t> reports_;  // frame number to reports so far
  Publisher publisher_;
  std::jthread thread_;
};

}  // namespace viewloom::load
