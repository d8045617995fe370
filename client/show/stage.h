// SPDX-License-Identifier: Apache-2.0
// The window on the monitor that is meant, ready to be drawn in.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/status.h"
#include "frame/size.h"
#include "show/painter.h"
#include "show/show_window.h"

namespace viewloom::show {

struct StageOptions {
  std::string title;
  std::optional<int> monitor;  // as the user said
  bool is_windowed = false;
  SizePx windowed_px;              // of a window that is not full screen
  std::optional<SizePx> panel_px;  // px of the window have to be these
};

// In the order in which they need one another.
struct Stage {
  std::unique_ptr<SdlVideo> video;
  std::unique_ptr<ShowWindow> window;
  std::unique_ptr<Painter> painter;
};

// INVALID_ARGUMENT: no such monitor, or a full screen whose px are not the panel's; of a smaller
// window that is only said. FAILED_PRECONDITION: no screen, or no OpenGL. Main thread.
absl::StatusOr<Stage> openStage(const StageOptions& options,
                                const std::function<void(const std::string&)>& say);

}  // namespace viewloom::show
