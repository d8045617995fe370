// SPDX-License-Identifier: Apache-2.0
// Runs the whole server with a publisher and a watcher over gRPC on loopback, as fast as it goes.
#pragma once

#include <cstdint>
#include <vector>

#include "base/status.h"
#include "config/config.h"
#include "lib/wire_frame.h"
#include "viewloom/v1/atlas.pb.h"

namespace viewloom {

// Means over the atlases received.
struct LoopbackReport {
  double seconds = 0;
  uint64_t atlas_count = 0;
  uint64_t atlas_bytes = 0;  // on the wire, of all atlases
  uint64_t skipped_count = 0;
  double receive_ms = 0;
  double decode_ms = 0;
  double upload_ms = 0;
  double build_ms = 0;
  double wait_ms = 0;
  double trace_ms = 0;
  double encode_ms = 0;
  double total_ms = 0;
  double other_share = 0;  // of the total, in none of the stages; stages that overlap count less
};

// Publishes the frames in turn, each as soon as the one before was sent, for so many seconds after
// the first atlas has come.
absl::StatusOr<LoopbackReport> measureLoopback(const Config& config, const v1::Display& display,
                                               const std::vector<WireFrame>& frames,
                                               double seconds);

}  // namespace viewloom
