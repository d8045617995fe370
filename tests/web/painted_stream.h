// SPDX-License-Identifier: Apache-2.0
// A stream without a device: atlases painted on the CPU, each view recognisable in the picture.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>

#include "eye_poses/eye_track.h"
#include "publish/broadcaster.h"
#include "publish/stream_directory.h"

namespace viewloom {

// Paints every display of its stream that is watched: one atlas for a display that has none, as a
// resident structure would give, and one for all of them with each frame. In the middle of view i,
// counted in the whole cone, stand eight squares, white for the bits of i that are set, highest
// first; a bar at the top moves with the frame number. A tracked display shows view i of 48 in a
// cone of 40 degrees, the nearest to its first eye, and is painted anew for new poses. Depth, where
// asked for, falls from left to right of each tile. Thread-safety: all methods may be called from
// any thread.
class PaintedStream final : public EyeSink {
 public:
  // per_megapixel: what an atlas takes at least; is_flat: view i of n is the grey 255 i / (n - 1)
  // and nothing else
  PaintedStream(std::string name, StreamDirectory& streams, Broadcaster& broadcaster,
                std::chrono::milliseconds per_megapixel, bool is_flat);
  ~PaintedStream() override;

  void publishFrame();
  // The broadcaster's news; starts painting for joiners.
  void noteDemand();
  void serveEyes(uint64_t display_id) override;

 private:
  void run(const std::stop_token& stop);
  void paint(const ActiveDisplay& display);

  const std::string name_;
  StreamDirectory& streams_;
  Broadcaster& broadcaster_;
  const std::chrono::milliseconds per_megapixel_;
  const bool is_flat_;
  std::unique_ptr<StreamDirectory::Claim> claim_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  uint64_t wanted_frame_ = 1;
  bool demand_ = false;
  std::set<uint64_t> moved_;                // displays with new poses
  uint64_t painted_frame_ = 0;              // the painter's own
  std::map<uint64_t, uint64_t> sequences_;  // by display; the painter's own
  std::jthread painter_;                    // last: stops before the rest goes
};

}  // namespace viewloom
