// SPDX-License-Identifier: Apache-2.0
// What watching a stream touches. All of it outlives the calls.
#pragma once

#include "base/clock.h"
#include "display/atlas_layout.h"
#include "eye_poses/eye_track.h"
#include "metrics/metrics.h"
#include "publish/broadcaster.h"
#include "publish/stream_directory.h"

namespace viewloom {

struct DisplayParts {
  StreamDirectory& directory;
  Broadcaster& broadcaster;
  EyeSink& eyes;
  const Clock& clock;
  const Metrics& metrics;
  AtlasLimits limits;
};

}  // namespace viewloom
