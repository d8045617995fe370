// SPDX-License-Identifier: Apache-2.0
// What publishing a stream touches. All of it outlives the calls and the frames they sent.
#pragma once

#include "base/byte_pool.h"
#include "base/clock.h"
#include "decode/frame_intake.h"
#include "frame/limits.h"
#include "metrics/metrics.h"
#include "publish/broadcaster.h"
#include "publish/stream_directory.h"

namespace viewloom {

struct IngestParts {
  FrameIntake& intake;
  BytePool& pool;
  StreamDirectory& directory;
  const Broadcaster& broadcaster;
  const Clock& clock;
  const Metrics& metrics;
  FrameLimits limits;
};

}  // namespace viewloom
