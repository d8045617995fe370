// SPDX-License-Identifier: Apache-2.0
#include "pipeline/aim.h"

namespace viewloom {
namespace {

// Adds the sources of a structure, with those that show things that move where these are by then.
void addSources(const ResidentStructure& structure, const std::optional<OutputTick>& tick,
                std::vector<SeenSource>& sources) {
  const size_t first = sources.size();
  sources.insert(sources.end(), structure.sources.begin(), structure.sources.end());
  if (!tick) return;
  for (const ThingPose& thing : tick->shown.things) {
    if (thing.source < structure.sources.size()) {
      sources[first + thing.source].camera.pose = thing.pose;
    }
  }
}

}  // namespace

Aim aimOf(const ActiveDisplay& display, const AtlasJob& job) {
  Camera camera = job.structure->sources.front().camera;
  if (job.tick) camera.pose = job.tick->shown.source_pose;
  Aim aim{.sources = {}, .display_pose = displayPose(display.spec, camera)};
  for (const ResidentStructure* structure : structuresOf(job)) {
    addSources(*structure, job.tick, aim.sources);
  }
  return aim;
}

std::vector<const ResidentStructure*> structuresOf(const AtlasJob& job) {
  std::vector<const ResidentStructure*> structures = {job.structure.get()};
  if (job.before) structures.push_back(job.before.get());
  return structures;
}

}  // namespace viewloom
