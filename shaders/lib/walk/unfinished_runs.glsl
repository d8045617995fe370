// SPDX-License-Identifier: Apache-2.0
// Runs of px that a software device did not finish: lavapipe ends all loops of an invocation after
// 65535 rounds of them together (shaders/README.md, Loops), and rays may pass thousands of cells
// each. They are listed, and a second dispatch walks their px, an invocation each.
#ifndef VIEWLOOM_LIB_WALK_UNFINISHED_RUNS_GLSL_
#define VIEWLOOM_LIB_WALK_UNFINISHED_RUNS_GLSL_

#include "lib/walk/walk_edges.glsl"
#include "lib/walk/walk_tasks.glsl"
#include "lib/walk/walk_views.glsl"

bool isOfUnfinished() {
  return (push.fill & kFillUnfinished) != 0u;
}

// Whether loops no longer go round. How often this one would no compiler knows, so none unrolls it.
bool areLoopsOver(Scene scene) {
  const uint enough = isNever(scene, 13u) ? 3u : 2u;
  uint rounds = 0u;
  for (;;) {
    if (isNever(scene, 16u)) break;
    ++rounds;
    if (rounds == enough) break;
  }
  return rounds != enough;
}

// A run of which px `first` and those after it are left; fewer than a group of px.
void listUnfinished(Task task, uint first) {
  const uint place = atomicAdd(unfinished.count, 1u);
  unfinished_list[place] = task.id * kTraceGroupSize + first;
  atomicAdd(unfinished.group_count.x, 1u);
}

// A px of a listed run, which nobody looks beside for edges.
Task taskOfUnfinished() {
  const uint entry = unfinished_list[gl_WorkGroupID.x];
  const uint id = entry / kTraceGroupSize;
  Task task = taskOfRun(id % runsOfRow(), id / runsOfRow());
  const uint i = entry % kTraceGroupSize + gl_LocalInvocationID.x;
  task.exists = i >= task.run.lead && i + task.run.trail < task.run.count;
  task.run.first_x += i;
  task.run.first_index += i;
  task.run.count = 1u;
  task.run.lead = 0u;
  task.run.trail = 0u;
  return task;
}

#endif  // VIEWLOOM_LIB_WALK_UNFINISHED_RUNS_GLSL_
