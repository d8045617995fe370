// SPDX-License-Identifier: Apache-2.0
#include "schedule/frame_ticket.h"

#include <utility>

namespace viewloom {

FrameTicket::FrameTicket(uint64_t frame_number, ReportFrame report) : send_(std::move(report)) {
  report_.number = frame_number;
}

FrameTicket::~FrameTicket() {
  if (send_) send_(report_);
}

void FrameTicket::noteRefused(std::string reason) {
  std::lock_guard lock(mutex_);
  report_.outcome = FrameOutcome::kRefused;
  report_.reason = std::move(reason);
}

void FrameTicket::noteBuilt(const SourceStats& stats, bool is_watched) {
  std::lock_guard lock(mutex_);
  report_.stats = stats;
  if (!is_watched) report_.outcome = FrameOutcome::kBuiltWithoutDisplay;
}

void FrameTicket::noteUnchanged(const SourceStats& stats) {
  std::lock_guard lock(mutex_);
  report_.outcome = FrameOutcome::kUnchanged;
  report_.stats = stats;
}

void FrameTicket::say(std::string note) {
  std::lock_guard lock(mutex_);
  report_.note = std::move(note);
}

void FrameTicket::noteTraced(const DisplayReport& display) {
  std::lock_guard lock(mutex_);
  report_.outcome = FrameOutcome::kTraced;
  report_.displays.push_back(display);
}

}  // namespace viewloom
