// SPDX-License-Identifier: Apache-2.0
#include "show/stage.h"

#include <utility>

#include "show/monitors.h"

namespace viewloom::show {

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
