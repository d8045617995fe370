// SPDX-License-Identifier: Apache-2.0
// Ticks whose picture has to be made of things that go on by themselves, which takes a while: it is
// made beside all other ticks.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "metrics/metrics.h"
#include "schedule/retime_schedule.h"

namespace viewloom {

// Serves ticks in the order of RetimeSchedule, of several streams at a time: on as many threads as
// there were such streams at once, each made when it is first needed. A tick that is replaced is
// counted.
// Thread-safety: offer() and isBusy() from any thread; stop() from one thread, once.
class RetimeLoop {
 public:
  // Makes what the job's tick shows and hands it on, or gives it up once a stop is requested.
  // Called on a thread of the loop, for one job of a stream at a time. Must not throw.
  using Serve =
      std::function<void(AtlasJob job, const DisplaySpec& spec, const std::stop_token& stop)>;

  RetimeLoop(const Metrics& metrics, Serve serve);
  ~RetimeLoop() { stop(); }

  // The job of a tick, of displays of this kind. False, and the tick is skipped, while its picture
  // is being served, or waits for what is being made for another one.
  bool offer(AtlasJob job, const ActiveDisplayPtr& display);
  // A tick of the picture waits or is being served.
  bool isBusy(const AtlasJob& job);
  // Waits for the ticks that are being served, which are to be given up, and forgets the others.
  void stop();

 private:
  void run();
  std::optional<RetimeSchedule::Tick> take();
  void finish(const std::string& stream);

  const Metrics& metrics_;
  const Serve serve_;
  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  RetimeSchedule schedule_;
  std::stop_source stop_;              // for all threads at once
  std::vector<std::jthread> threads_;  // last: they use all of the above
};

}  // namespace viewloom
