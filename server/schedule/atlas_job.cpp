// SPDX-License-Identifier: Apache-2.0
#include "schedule/atlas_job.h"

#include <algorithm>
#include <utility>

#include "display/atlas_layout.h"
#include "display/tracked_eyes.h"

namespace viewloom {

void addPayers(const Payers& more, Payers& payers) {
  for (const Payer& payer : more) {
    if (std::ranges::find(payers, payer) == payers.end()) payers.push_back(payer);
  }
}

Claim claimOf(const AtlasJob& job) {
  return {.deadline_ns = job.deadline_ns,
          .is_tracked = job.is_tracked,
          .payers = job.payers,
          .stream = job.structure ? job.structure->stream : "",
          .display = job.picture_key};
}

bool asksForNewer(const AtlasJob& job) {
  return !job.is_tracked && !job.tick;
}

int64_t deadlineNs(const DisplaySpec& spec, int64_t now_ns) {
  const int64_t due_ns = now_ns + kDueNsPerRay * rayCount(spec);
  return isTracked(spec) ? due_ns - kEyesAhead_ns : due_ns;
}

std::vector<AtlasJob> jobsOfFrame(const ResidentPtr& structure,
                                  const std::vector<ActiveDisplayPtr>& displays,
                                  const FrameTicketPtr& ticket, int64_t now_ns) {
  std::vector<AtlasJob> jobs;
  for (const ActiveDisplayPtr& display : displays) {
    if (display->spec.temporal) continue;
    const auto same = std::ranges::find(jobs, display->picture_key, &AtlasJob::picture_key);
    if (same != jobs.end()) {
      addPayers(display->viewers, same->payers);
      continue;
    }
    jobs.push_back({.picture_key = display->picture_key,
                    .structure = structure,
                    .deadline_ns = deadlineNs(display->spec, now_ns),
                    .ticket = ticket,
                    .is_tracked = isTracked(display->spec),
                    .poses = display->eyes ? display->eyes->times() : PoseTimes{},
                    .asked_ns = now_ns,
                    .payers = display->viewers});
  }
  return jobs;
}

std::vector<AtlasJob> jobsForWaiting(const ResidentPtr& resident,
                                     const std::vector<ActiveDisplayPtr>& displays,
                                     int64_t now_ns) {
  std::vector<AtlasJob> jobs = jobsOfFrame(resident, displays, nullptr, now_ns);
  std::erase_if(jobs, [](const AtlasJob& job) { return !asksForNewer(job); });
  return jobs;
}

AtlasJob jobForEyes(const ActiveDisplay& display, ResidentPtr structure, int64_t now_ns) {
  return {.picture_key = display.picture_key,
          .structure = std::move(structure),
          .deadline_ns = deadlineNs(display.spec, now_ns),
          .ticket = nullptr,
          .is_for_eyes = true,
          .is_tracked = true,
          .poses = display.eyes->times(),
          .asked_ns = now_ns,
          .payers = display.viewers};
}

}  // namespace viewloom
