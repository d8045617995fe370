// SPDX-License-Identifier: Apache-2.0
// The one report that every offered frame gets, whatever becomes of it.
#pragma once

#include <memory>
#include <mutex>

#include "frame/frame_sink.h"

namespace viewloom {

// Held by whatever still works on the frame; reports when the last holder lets go.
// Thread-safety: all methods may be called from any thread.
class FrameTicket {
 public:
  // Until it is built, the frame counts as replaced.
  FrameTicket(uint64_t frame_number, ReportFrame report);
  ~FrameTicket();
  FrameTicket(const FrameTicket&) = delete;
  FrameTicket& operator=(const FrameTicket&) = delete;

  void noteRefused(std::string reason);
  // Resident; `is_watched` = displays wait for it, so without an atlas it was replaced.
  void noteBuilt(const SourceStats& stats, bool is_watched);
  // Nothing is made of it: the resident frame, of which these are the stats, is the same.
  void noteUnchanged(const SourceStats& stats);
  void noteTraced(const DisplayReport& display);
  // For the publisher's eyes.
  void say(std::string note);

 private:
  const ReportFrame send_;
  std::mutex mutex_;
  FrameReport report_;
};

using FrameTicketPtr = std::shared_ptr<FrameTicket>;

}  // namespace viewloom
