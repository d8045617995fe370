// SPDX-License-Identifier: Apache-2.0
// Suspicions about published frames, found beside publishing them.
#pragma once

#include <chrono>
#include <future>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "cli/frame_loader.h"

namespace viewloom::cli {

// Looks at the first frame, and at a later one when ten seconds have passed since: a thread of its
// own does, so that no frame waits. Each kind of warning is said once. Thread-safety: none; one
// owner.
class FirstLook {
 public:
  explicit FirstLook(const LoaderOptions& options) : options_(options) {}
  ~FirstLook() { stop_.request_stop(); }
  FirstLook(const FirstLook&) = delete;
  FirstLook& operator=(const FirstLook&) = delete;

  void offer(const FrameFiles& files, const files::LoadedFrame& frame);
  // Adds what has been found since the last call.
  void takeWarnings(std::vector<std::string>& notes);
  // The same, once the look that goes on has ended: at Ctrl-C it is broken off.
  void finish(std::vector<std::string>& notes);

 private:
  struct Warning {
    std::string kind;
    std::string text;
  };
  static std::vector<Warning> look(const FrameFiles& files, const files::LoadedFrame& frame,
                                   const LoaderOptions& options, const std::stop_token& stop);

  const LoaderOptions options_;
  std::optional<std::chrono::steady_clock::time_point> looked_at_;
  std::set<std::string> said_;
  std::stop_source stop_;
  std::future<std::vector<Warning>> looking_;  // last: it ends before the rest goes
};

}  // namespace viewloom::cli
