// SPDX-License-Identifier: Apache-2.0
// Lets the frames of one stream in to be decoded and built, one at a time.
#pragma once

#include <cstdint>
#include <mutex>

namespace viewloom {

// A frame waits outside, as it was received, until there is a reason to build it. So what would be
// replaced costs nothing, and its publisher can send no other meanwhile. Thread-safety: all methods
// may be called from any thread.
class FrameDoor {
 public:
  enum class Answer : uint8_t {
    kComeIn,  // to be decoded now
    kFirst,   // it waits, and none has waited so far
    kWaitOn   // it waits, as it did, or until the one that was let in is built
  };
  // A frame waits outside. May be called again while it does.
  Answer knock();
  // A frame has come in, which may be one that did not knock. True: it waits inside, and none has
  // waited so far.
  bool enter();

  enum class Opened : uint8_t {
    kNobody,  // no frame waits, and none was let in
    kNow,     // one waits, and may come in
    kBefore   // one was let in, and is not built yet
  };
  // A frame is wanted.
  Opened open();
  // The frame that was let in is built, or never will be.
  void close();

  // A frame waits, and none was let in.
  bool hasWaiting() const;
  // A frame was let in, and is not built yet.
  bool isOpen() const;

 private:
  enum class State : uint8_t { kEmpty, kWaits, kOpen, kIsIn };

  mutable std::mutex mutex_;
  State state_ = State::kEmpty;  // guarded by mutex_
};

}  // namespace viewloom
