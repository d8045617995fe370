// SPDX-License-Identifier: Apache-2.0
#include "show/stage.h"

#include <SDL.h>
#include <epoxy/gl.h>

#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include "base/str_cat.h"
#include "show/monitors.h"

namespace viewloom::show {
namespace {

// SDL falls back on drivers that no eye sees.
bool drawsNowhere(std::string_view driver) {
  return driver == "dummy" || driver == "offscreen";
}

// Wayland is found through its runtime folder. Without one, its library would print an error of
// its own.
bool mayHaveWayland() {
  const char* const folder = std::getenv("XDG_RUNTIME_DIR");
  const char* const socket = std::getenv("WAYLAND_DISPLAY");
  return (folder != nullptr && folder[0] == '/') || (socket != nullptr && socket[0] == '/') ||
         std::getenv("WAYLAND_SOCKET") != nullptr;
}

// SDL's drivers, in its order; SDL_VIDEODRIVER in the environment overrules it.
void leaveWaylandOut() {
  std::string drivers;
  for (int number = 0; number < SDL_GetNumVideoDrivers(); ++number) {
    const std::string_view driver = SDL_GetVideoDriver(number);
    if (driver == "wayland" || drawsNowhere(driver)) continue;
    drivers += strCat(drivers.empty() ? "" : ",", driver);
  }
  SDL_SetHint(SDL_HINT_VIDEODRIVER, drivers.c_str());
}

void askForContext(bool is_gles) {
  SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK,
                      is_gles ? SDL_GL_CONTEXT_PROFILE_ES : SDL_GL_CONTEXT_PROFILE_CORE);
  SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
  SDL_GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, is_gles ? 0 : 3);
  SDL_GL_SetAttribute(SDL_GL_DOUBLEBUFFER, 1);
}

}  // namespace

absl::StatusOr<std::unique_ptr<SdlVideo>> SdlVideo::start() {
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
  // A click on another monitor must not take the picture off the panel.
  SDL_SetHint(SDL_HINT_VIDEO_MINIMIZE_ON_FOCUS_LOSS, "0");
  if (!mayHaveWayland()) leaveWaylandOut();
  const bool is_started = SDL_InitSubSystem(SDL_INIT_VIDEO) == 0;
  std::unique_ptr<SdlVideo> video(new SdlVideo);
  if (is_started && !drawsNowhere(SDL_GetCurrentVideoDriver())) return video;
  return absl::FailedPreconditionError(
      "there is no screen to show on; start viewloom in a desktop session, or set DISPLAY");
}

SdlVideo::~SdlVideo() {
  SDL_Quit();
}

absl::StatusOr<std::unique_ptr<ShowWindow>> ShowWindow::open(const WindowOptions& options) {
  std::unique_ptr<ShowWindow> window(new ShowWindow);
  const int centre = static_cast<int>(
      SDL_WINDOWPOS_CENTERED_DISPLAY(static_cast<unsigned>(options.monitor.number)));
  const SizePx size_px = options.is_windowed ? options.windowed_px : options.monitor.size_px;
  const uint32_t kind = options.is_windowed ? SDL_WINDOW_BORDERLESS
                                            : SDL_WINDOW_FULLSCREEN_DESKTOP | SDL_WINDOW_BORDERLESS;
  for (const bool is_gles : {false, true}) {
    askForContext(is_gles);
    window->window_ = SDL_CreateWindow(
        options.title.c_str(), centre, centre, static_cast<int>(size_px.width),
        static_cast<int>(size_px.height), SDL_WINDOW_OPENGL | SDL_WINDOW_ALLOW_HIGHDPI | kind);
    if (window->window_ == nullptr) continue;
    window->context_ = SDL_GL_CreateContext(window->window_);
    window->is_gles_ = is_gles;
    if (window->context_ != nullptr) break;
    SDL_DestroyWindow(window->window_);
    window->window_ = nullptr;
  }
  if (window->window_ == nullptr) {
    return absl::FailedPreconditionError(strCat("no window with OpenGL 3.3 or OpenGL ES 3.0 (",
                                                SDL_GetError(),
                                                "); install the driver of the graphics card"));
  }
  SDL_GL_SetSwapInterval(1);
  if (!options.is_windowed) SDL_ShowCursor(SDL_DISABLE);
  return window;
}

ShowWindow::~ShowWindow() {
  if (context_ != nullptr) SDL_GL_DeleteContext(context_);
  if (window_ != nullptr) SDL_DestroyWindow(window_);
}

SizePx ShowWindow::sizePx() const {
  int width_px = 0, height_px = 0;
  SDL_GL_GetDrawableSize(window_, &width_px, &height_px);
  return {static_cast<uint32_t>(width_px), static_cast<uint32_t>(height_px)};
}

void ShowWindow::toggleFullScreen() {
  const bool is_full = (SDL_GetWindowFlags(window_) & SDL_WINDOW_FULLSCREEN_DESKTOP) ==
                       SDL_WINDOW_FULLSCREEN_DESKTOP;
  SDL_SetWindowFullscreen(window_, is_full ? 0 : SDL_WINDOW_FULLSCREEN_DESKTOP);
  SDL_ShowCursor(is_full ? SDL_ENABLE : SDL_DISABLE);
}

void ShowWindow::swap() {
  SDL_GL_SwapWindow(window_);
  glFinish();
}

absl::StatusOr<Stage> openStage(const StageOptions& options,
                                const std::function<void(const std::string&)>& say) {
  absl::StatusOr<std::unique_ptr<SdlVideo>> video = SdlVideo::start();
  if (!video.ok()) return video.status();
  const absl::StatusOr<Monitor> monitor =
      chooseMonitor(listMonitors(), {options.monitor, options.panel_px, options.is_windowed});
  if (!monitor.ok()) return monitor.status();
  absl::StatusOr<std::unique_ptr<ShowWindow>> window =
      ShowWindow::open({.title = options.title,
                        .monitor = *monitor,
                        .is_windowed = options.is_windowed,
                        .windowed_px = options.windowed_px});
  if (!window.ok()) return window.status();
  if (options.panel_px) {
    absl::Status native = checkNativePixels((*window)->sizePx(), *options.panel_px);
    if (!native.ok() && !options.is_windowed) return native;
    if (!native.ok()) say(std::string(native.message()));
  }
  absl::StatusOr<std::unique_ptr<Painter>> painter = Painter::make((*window)->isGles());
  if (!painter.ok()) return painter.status();
  return Stage{*std::move(video), *std::move(window), *std::move(painter)};
}

}  // namespace viewloom::show
