// SPDX-License-Identifier: Apache-2.0
#include "pipeline/job_aim.h"

namespace viewloom {

Aim aimOf(const ActiveDisplay& display, const AtlasJob& job) {
  Camera camera = job.structure->sources.front().camera;
  if (job.tick) camera.pose = job.tick->shown.source_pose;
  Aim aim{.sources = job.structure->sources, .display_pose = displayPose(display.spec, camera)};
  if (!job.before) return aim;
  const std::vector<SeenSource>& before = job.before->sources;
  aim.sources.insert(aim.sources.end(), before.begin(), before.end());
  return aim;
}

}  // namespace viewloom
