// SPDX-License-Identifier: Apache-2.0
// The window system, one window on the monitor that is meant, and its OpenGL context. Its px are
// drawn as they are, without scaling and without colour management.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/status.h"
#include "frame/size.h"
#include "show/monitors.h"
#include "show/painter.h"

struct SDL_Window;

namespace viewloom::show {

// The window system, for as long as this lives. Ctrl-C stays the program's.
// Thread-safety: main thread.
class SdlVideo {
 public:
  // FAILED_PRECONDITION when there is no screen.
  static absl::StatusOr<std::unique_ptr<SdlVideo>> start();
  ~SdlVideo();
  SdlVideo(const SdlVideo&) = delete;
  SdlVideo& operator=(const SdlVideo&) = delete;

 private:
  SdlVideo() = default;
};

struct WindowOptions {
  std::string title;
  Monitor monitor;
  bool is_windowed = false;
  SizePx windowed_px;  // without frame and buttons
};

// OpenGL 3.3, or OpenGL ES 3.0 where that is all there is; its context is current.
// Thread-safety: main thread.
class ShowWindow {
 public:
  // FAILED_PRECONDITION when there is no such window or no such OpenGL.
  static absl::StatusOr<std::unique_ptr<ShowWindow>> open(const WindowOptions& options);
  ~ShowWindow();
  ShowWindow(const ShowWindow&) = delete;
  ShowWindow& operator=(const ShowWindow&) = delete;

  // The area that can be drawn on, in px of the screen.
  SizePx sizePx() const;
  bool isGles() const { return is_gles_; }
  void toggleFullScreen();
  // Shows what was drawn; returns when the screen has taken it.
  void swap();

 private:
  ShowWindow() = default;

  SDL_Window* window_ = nullptr;
  void* context_ = nullptr;  // SDL_GLContext
  bool is_gles_ = false;
};

struct StageOptions {
  std::string title;
  std::optional<int> monitor;  // as the user said
  bool is_windowed = false;
  SizePx windowed_px;              // of a window that is not full screen
  std::optional<SizePx> panel_px;  // px of the window have to be these
};

// The window, ready to be drawn in. In the order in which they need one another.
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
