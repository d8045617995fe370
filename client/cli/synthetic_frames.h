// SPDX-License-Identifier: Apache-2.0
// A built-in scene as a feed.
#pragma once

#include "cli/frame_feed.h"
#include "frame/size.h"
#include "synthetic/scene.h"

namespace viewloom::cli {

struct SyntheticFeedOptions {
  SizePx size_px;  // 0 x 0 = that of the setting
  synthetic::Setting setting = synthetic::Setting::kBalls;
  uint32_t layer_count = 2;
  uint32_t source_count = 1;
  bool has_moving_camera = false;  // the first sways; the others stand beside it
  bool is_cube_map = false;        // with faces as high as size_px; then one source
  bool has_mirrors = false;        // then one source, no cube map
  bool has_motion = false;         // says how things move; then no cube map
  double duration_s = 0;           // 0 = without end
};

class SyntheticFrames final : public FrameFeed {
 public:
  explicit SyntheticFrames(const SyntheticFeedOptions& options);
  absl::StatusOr<std::optional<WireFrame>> next(double elapsed_s) override;
  std::string description() const override;
  bool isLive() const override { return true; }

 private:
  const SyntheticFeedOptions options_;
};

}  // namespace viewloom::cli
