// SPDX-License-Identifier: Apache-2.0
// Lets frames in when it is the turn of a picture that shows them.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "base/clock.h"
#include "pipeline/asked_pictures.h"
#include "pipeline/stream_table.h"
#include "publish/broadcaster.h"
#include "schedule/atlas_job.h"

namespace viewloom {

// A frame waits undecoded, and the pictures of its stream queue for their turns. The first whose
// turn comes and that has nothing new to show asks for the frame. It and all others that ask
// meanwhile begin once the frame is built. So each built frame is shown. Newer ones replace a frame
// that waits for long (rpc/held_back.h), and fewer are asked for (rpc/used_rate.h).
// Thread-safety: all methods may be called from any thread.
class FrameEntrance {
 public:
  // Called on the threads that call the entrance.
  struct Events {
    std::function<void(AtlasJob job)> offer;  // it waits for its turn from now on
    std::function<void(const std::string& picture_key)> finish;  // it may begin
    std::function<void()> on_finished;                           // some may begin
    std::function<void()> ring_builds;                           // look at all streams again
    // Whether a waiting frame is built although no picture has asked.
    std::function<bool(const PipelineStream& stream)> takes_unasked;
  };

  // The parts outlive it.
  FrameEntrance(StreamTable& streams, const Broadcaster& broadcaster, const Clock& clock,
                Events events)
      : streams_(streams), broadcaster_(broadcaster), clock_(clock), events_(std::move(events)) {}

  // See FrameSink.
  bool wantsFrame(const std::string& stream);
  void onWanted(std::function<void(const std::string&)> then) { on_wanted_ = std::move(then); }
  void noteLost(const std::string& stream);
  // A decoded frame is in the inbox of the stream.
  void noteOffered(const PipelineStreamPtr& stream);

  // It is the turn of a picture, and it has nothing new to show. True: a frame comes, and the
  // picture is finished when that is built.
  bool askNewer(const std::string& stream, const std::string& picture_key);
  // The waiting frame of the stream, if there is one, is decoded and built. False: none comes.
  bool letIn(PipelineStream& stream);
  // A picture has begun: its next one may ask for the frame that waits, or takes it.
  void noteBegun(const AtlasJob& job);
  // The frame that was let in has been looked at: the pictures that asked for it may begin, and the
  // next frame may wait.
  void goOn(PipelineStream& stream);
  void forget(const std::string& stream);
  // Nobody waits for frames any more.
  void stop() { is_stopped_ = true; }

 private:
  bool takesUnasked(const PipelineStream& stream) const;
  // Pictures of the stream, or those of this key alone.
  void queuePictures(const PipelineStream& stream, std::optional<std::string> picture_key = {});
  void beginAsked(const std::string& stream);

  StreamTable& streams_;
  const Broadcaster& broadcaster_;
  const Clock& clock_;
  const Events events_;
  std::function<void(const std::string& stream)> on_wanted_ = [](const std::string&) {};
  AskedPictures asked_;
  std::atomic<bool> is_stopped_ = false;
};

}  // namespace viewloom
