// SPDX-License-Identifier: Apache-2.0
// Takes frames of publishers and eyes of viewers, and gives the Broadcaster atlases.
#pragma once

#include <string>

#include "eye_poses/eye_track.h"
#include "frame/frame_sink.h"
#include "publish/broadcaster.h"

namespace viewloom {

// Thread-safety: all methods may be called from any thread.
class AtlasMaker : public FrameSink, public EyeSink {
 public:
  // The displays of a stream changed: those without an atlas of its newest frame get one.
  virtual void serveDisplays(const std::string& stream) = 0;
  // Takes no more frames, finishes and publishes the atlases that have begun, reports every frame.
  virtual void drain() = 0;
};

}  // namespace viewloom
