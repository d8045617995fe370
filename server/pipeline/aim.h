// SPDX-License-Identifier: Apache-2.0
// The structures of a job that a display sees, and the place it sees them from.
#pragma once

#include <vector>

#include "picture/trace_job.h"
#include "publish/broadcaster.h"
#include "schedule/atlas_job.h"

namespace viewloom {

struct Aim {
  std::vector<SeenSource> sources;
  Pose display_pose;  // in the world

  // In the place of the only source: the same is seen wherever that is.
  bool standsInOnly() const {
    return sources.size() == 1 && sources.front().camera.pose == display_pose;
  }
  bool operator==(const Aim&) const = default;
};

// A display without a place of its own stands where the camera is at the time shown.
Aim aimOf(const ActiveDisplay& display, const AtlasJob& job);

// The structures that the picture of a job is made of.
std::vector<const ResidentStructure*> structuresOf(const AtlasJob& job);

}  // namespace viewloom
