// SPDX-License-Identifier: Apache-2.0
// Replaces the pipeline in tests without a device: answers frames with atlases of known bytes.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "eye_poses/eye_track.h"
#include "frame/frame_sink.h"
#include "publish/broadcaster.h"
#include "publish/stream_directory.h"

namespace viewloom {

// The byte at this place of every RAW colour band; depends on what must not be mixed up.
uint8_t expectedByte(uint64_t frame_number, uint32_t first_row, size_t index);

// Thread-safety: all methods may be called from any thread.
class AnsweringSink final : public FrameSink, public EyeSink {
 public:
  AnsweringSink(StreamDirectory& directory, Broadcaster& broadcaster);

  void offerFrame(const FrameOrigin& origin, FramePtr frame, ReportFrame report) override;
  void forgetStream(const std::string& stream) override;
  void serveEyes(uint64_t) override {}  // known bytes look the same to all eyes

  // Serves displays without an atlas from the resident frame.
  void demandChanged(const std::string& stream);
  // The newest answered frame, as the server decoded it; null before the first.
  FramePtr resident(const std::string& stream);
  // From now on, only the newest frame of the stream waits. None is answered.
  void hold(const std::string& stream);
  // Answers the waiting frame and all later ones.
  void letGo(const std::string& stream);

 private:
  struct Offered {
    FramePtr frame;
    ReportFrame report;
  };
  struct Resident {
    FramePtr frame;
    bool held = false;
    std::optional<Offered> waiting;
  };

  FrameReport answer(const std::string& stream, const FramePtr& frame);  // with the lock
  DisplayReport publishAtlas(const ActiveDisplay& display, const Frame& frame);

  StreamDirectory& directory_;
  Broadcaster& broadcaster_;
  std::mutex mutex_;
  std::map<std::string, Resident> streams_;
};

}  // namespace viewloom
