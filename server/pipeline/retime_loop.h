// SPDX-License-Identifier: Apache-2.0
// Ticks whose picture has to be made of things that go on by themselves, which takes a while: it is
// made beside all other ticks.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "metrics/metrics.h"
#include "pipeline/job_queue.h"
#include "publish/broadcaster.h"

namespace viewloom {

// Ticks of one stream are served one after the other, the picture that waits longest first, and
// those of several streams at a time: on as many threads as there were such streams at once, each
// made when it is first needed. Of a picture no more than one tick waits, the newest: what it
// replaces is a tick skipped, and counted.
// Thread-safety: offer() and isBusy() from any thread; stop() from one thread, once.
class RetimeLoop {
 public:
  // Makes what the job's tick shows and hands it on. Called on a thread of the loop, for one job of
  // a stream at a time. Must not throw.
  using Serve = std::function<void(AtlasJob job, const DisplaySpec& spec)>;

  RetimeLoop(const Metrics& metrics, Serve serve);
  ~RetimeLoop() { stop(); }

  // The job of a tick, of displays of this kind. False, and the tick is skipped, while its picture
  // is being served, or waits for what is being made for another one.
  bool offer(AtlasJob job, const ActiveDisplayPtr& display);
  // A tick of the picture waits or is being served.
  bool isBusy(const AtlasJob& job);
  // Finishes the ticks that are being served, and forgets the others.
  void stop();

 private:
  struct Tick {
    AtlasJob job;
    ActiveDisplayPtr display;
  };
  struct Stream {
    std::vector<Tick> waiting;        // one of each picture, longest waiting first
    std::optional<AtlasJob> in_hand;  // without its ticket
  };
  using Streams = std::map<std::string, Stream>;  // by name, those that have ticks

  void run();
  std::optional<Tick> take();
  void finish(const std::string& stream);

  const Metrics& metrics_;
  const Serve serve_;
  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  Streams streams_;
  bool is_stopped_ = false;
  std::vector<std::jthread> threads_;  // last: they use all of the above
};

}  // namespace viewloom
