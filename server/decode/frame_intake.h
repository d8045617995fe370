// SPDX-License-Identifier: Apache-2.0
// The hand-over from the network to the loops: newest frame of each stream wins, then it is
// decoded.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "base/byte_pool.h"
#include "base/clock.h"
#include "decode/frame_assembly.h"
#include "frame/frame_sink.h"

namespace viewloom {

struct FrameIntakeOptions {
  uint32_t thread_count = 2;
  std::function<void()> on_replaced = [] {};  // for each frame reported kReplaced here; any thread
};

// Decodes on threads of its own, the planes of a frame side by side. Of each stream one frame waits
// at most: a newer one replaces it, and it is reported kReplaced. It waits until the sink wants it:
// no frame is decoded that would only be replaced. Large frames leave one thread, if there are
// several, to small ones. Frames of one stream are decoded
// one after the other and reach the sink in the order in which they were offered; one that does not
// decode, or for which memory runs out, is reported kRefused. A frame gives its reservation back
// when its last reader lets go of it.
// Thread-safety: all methods may be called from any thread. offer never blocks.
class FrameIntake {
 public:
  // Sink, clock and pool must outlive the intake.
  FrameIntake(FrameSink& sink, const Clock& clock, BytePool& pool, FrameIntakeOptions options);
  // Closes.
  ~FrameIntake();

  // Fills in times.decoded_ns. `report` is called exactly once, by the intake or by the sink.
  // `on_taken` is called once, on any thread, when the frame waits no longer: another one would not
  // replace it.
  void offer(
      const std::string& stream, CollectedFrame frame, FrameTimes times, ReportFrame report,
      std::function<void()> on_taken = [] {});
  // The sink may want the frame of this stream that it did not want. Until then it is not asked
  // again about it, however many others wait.
  void resume(const std::string& stream);
  // The stream is to be forgotten: what waits of it is reported kRefused, and comes back to no
  // sink. False, and nothing is changed, while a frame of it is decoded or handed over.
  bool forget(const std::string& stream);

  // Waits until every frame that was accepted has gone to the sink or been reported. Frames offered
  // from now on are reported kRefused.
  void close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace viewloom
