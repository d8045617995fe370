// SPDX-License-Identifier: Apache-2.0
// How many frames a second of a publisher are used, to ask it for no more.
#pragma once

#include <cstdint>
#include <deque>

namespace viewloom {

// While all frames are used as they come, there is no limit. When some are replaced by newer ones,
// the limit is a little more than the frames that were used, but at least half of those that came.
// When frames wait for their turn nearly all the time, so that the publisher is held back and its
// frames grow old, the limit is a little less than the frames that were used, however rare these
// are, but at least one frame in ten seconds. It rises again while neither happens, faster and
// faster.
// Thread-safety: none.
class UsedRate {
 public:
  // A frame was used, or a newer one has replaced it. True if the limit is another one now.
  bool note(bool is_used, int64_t now_ns);
  // A frame has waited so long for its turn, and meanwhile no other was received. As above.
  bool noteTurn(int64_t waited_ns, int64_t now_ns);
  // Forgets everything: the frames are wanted otherwise now.
  void reset() { *this = {}; }

  // Frames a second; 0 = as many as there are.
  double limitHz() const { return limit_hz_; }

 private:
  // Factor of the first rise, after a window without replaced frames; squared for each that
  // follows. So a publisher that lost frames in a short crowd is soon back, and one that sends too
  // much is not tempted.
  static constexpr double kRise = 1.25;

  struct Outcome {
    int64_t time_ns = 0;
    bool is_used = false;
  };

  struct Turn {
    int64_t time_ns = 0;
    int64_t waited_ns = 0;
  };

  bool judge(int64_t now_ns);
  int64_t windowNs() const;
  double waitedShare() const;  // of turns_, of which there are some
  double heldBackHz() const;
  bool lower(double rate_hz, int64_t now_ns);
  bool raise(double received_hz, int64_t now_ns);
  bool leap(int64_t now_ns);
  void change(double limit_hz, int64_t now_ns);

  // In the last while, since the limit was changed.
  std::deque<Outcome> outcomes_;
  std::deque<Turn> turns_;
  double limit_hz_ = 0;
  int64_t changed_ns_ = 0;  // the limit
  double rise_ = kRise;     // factor of the next rise
  // The limit leaps as soon as turns show room: the crowd may have gone, or kernels are compiled.
  // If that was too much, it falls again, and rises without leaps until it has gone.
  bool may_leap_ = true;
  bool has_leapt_ = false;
};

}  // namespace viewloom
