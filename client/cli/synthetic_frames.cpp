// SPDX-License-Identifier: Apache-2.0
#include "cli/synthetic_frames.h"

#include <chrono>

#include "base/str_cat.h"
#include "synthetic/synthetic_wire_frame.h"

namespace viewloom::cli {

int64_t captureTimeNs() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

SyntheticFrames::SyntheticFrames(const SyntheticFeedOptions& options) : options_(options) {}

absl::StatusOr<std::optional<WireFrame>> SyntheticFrames::next(double elapsed_s) {
  if (options_.duration_s > 0 && elapsed_s >= options_.duration_s) {
    return std::optional<WireFrame>();
  }
  const SyntheticOptions scene{.size_px = options_.size_px,
                               .layer_count = options_.layer_count,
                               .time_s = elapsed_s,
                               .camera = {}};
  return syntheticWireFrame(scene, captureTimeNs());
}

std::string SyntheticFrames::description() const {
  return strCat("synthetic scene, ", options_.size_px.width, "x", options_.size_px.height, ", ",
                options_.layer_count, options_.layer_count == 1 ? " layer" : " layers");
}

}  // namespace viewloom::cli
