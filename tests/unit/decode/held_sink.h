// SPDX-License-Identifier: Apache-2.0
// Surroundings of the intake in its tests: frames of one pixel, a sink, and all reports.
#pragma once

#include <gtest/gtest.h>

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "decode/frame_intake.h"

namespace viewloom::test {

// A frame of one pixel. Depth that claims to be zstd is refused when it is decoded.
inline CollectedFrame onePixel(uint64_t number, bool broken = false) {
  LayerFormat layer{.color = {.size_px = {1, 1}, .wire_bytes = 4},
                    .depth = {.kind = PlaneKind::kDepth,
                              .encoding = PlaneEncoding::kDepthU16,
                              .size_px = {1, 1},
                              .wire_bytes = 2}};
  if (broken) layer.depth.compression = PlaneCompression::kZstd;
  CollectedFrame frame{.format = {.number = number, .sources = {{.layers = {layer}}}},
                       .planes = {}};
  frame.planes = {std::make_shared<const std::vector<uint8_t>>(4, uint8_t{1}),
                  std::make_shared<const std::vector<uint8_t>>(2, uint8_t{1})};
  return frame;
}

// Keeps what it is offered; can hold up whoever offers.
class HeldSink : public FrameSink {
 public:
  void offerFrame(const FrameOrigin& origin, FramePtr frame, ReportFrame report) override {
    std::unique_lock lock(mutex_);
    offered_[origin.stream].push_back(frame->format.number);
    newest_ = frame;
    ++offered_count_;
    changed_.notify_all();
    changed_.wait(lock, [this] { return !held_; });
    lock.unlock();
    report({.number = frame->format.number, .outcome = FrameOutcome::kTraced});
  }
  void forgetStream(const std::string&) override {}

  void hold() {
    std::lock_guard lock(mutex_);
    held_ = true;
  }
  void letGo() {
    std::lock_guard lock(mutex_);
    held_ = false;
    changed_.notify_all();
  }
  void waitForOffer() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return offered_count_ > 0; });
  }
  std::vector<uint64_t> offered(const std::string& stream) {
    std::lock_guard lock(mutex_);
    return offered_[stream];
  }
  FramePtr newest() {
    std::lock_guard lock(mutex_);
    return newest_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, std::vector<uint64_t>> offered_;
  FramePtr newest_;
  int offered_count_ = 0;
  bool held_ = false;
};

// All reports of a test, by stream.
class Reports {
 public:
  ReportFrame into(const std::string& stream) {
    return [this, stream](const FrameReport& report) {
      std::lock_guard lock(mutex_);
      reports_[stream].push_back(report);
    };
  }
  // Number to outcome; a frame reported twice fails the test.
  std::map<uint64_t, FrameOutcome> outcomes(const std::string& stream) {
    std::lock_guard lock(mutex_);
    std::map<uint64_t, FrameOutcome> outcomes;
    for (const FrameReport& report : reports_[stream]) {
      EXPECT_TRUE(outcomes.emplace(report.number, report.outcome).second) << report.number;
    }
    return outcomes;
  }
  std::string reason(const std::string& stream) {
    std::lock_guard lock(mutex_);
    return reports_[stream].front().reason;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::vector<FrameReport>> reports_;
};

}  // namespace viewloom::test
