// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"

#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "base/output_file.h"
#include "base/str_cat.h"
#include "cli/display_options.h"
#include "cli/interrupt.h"
#include "cli/report_error.h"
#include "cli/server_options.h"
#include "cli/status_line.h"
#include "cli/stream_wait.h"
#include "show/find_calibration.h"
#include "show/show_session.h"
#include "show/tune_session.h"
#include "usage/command_line.h"

namespace viewloom::cli {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;

struct ShowOptions {
  std::string stream = "demo";
  DisplayOptions display;
  std::string mode;  // "": what suits panel, display and server
  std::string calibration_file;
  std::string eye_file;  // "" = the eyes are the display's own
  std::optional<int> monitor;
  bool is_windowed = false;
  std::optional<uint32_t> view;
  uint32_t pair_distance = 0;
  std::string views_between = "blend";
  bool has_statistics = false;
  bool is_tuning = false;
  std::string out_file = "visual.json";
};

constexpr char kNoPanel[] =
    " needs a calibrated panel, and no calibration was found. Plug in the panel's USB storage, or "
    "name its visual.json with --calibration";

absl::Status checkMode(show::ShowMode mode, bool is_calibrated) {
  const bool is_for_panel = mode == show::ShowMode::kNative || mode == show::ShowMode::kWeave;
  if (!is_for_panel || is_calibrated) return absl::OkStatus();
  return absl::InvalidArgumentError(strCat("--mode ", show::nameOf(mode), kNoPanel));
}

// Eyes move the views of a stereo display; a panel has all of them at once.
absl::Status checkEyes(show::ShowMode mode, const v1::Display& display) {
  if (mode == show::ShowMode::kNative || mode == show::ShowMode::kWeave) {
    return absl::InvalidArgumentError(strCat(
        "--mode ", show::nameOf(mode),
        " is for a panel that shows all views at once. With --eyes-from, --mode accepts pair, "
        "view and quilt"));
  }
  if (display.stereo().tracked()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      "--eyes-from needs a display that tracks a head. Name one with --display: its stereo has "
      "\"tracked\": true");
}

// The quilt that a calibration suggests, if the user names none.
absl::StatusOr<v1::Display> displayOf(DisplayOptions options,
                                      const std::optional<Calibration>& calibration) {
  const bool is_said = !options.file.empty() || !options.preset.empty() || options.columns > 0;
  if (!calibration || is_said) return makeDisplay(options);
  options.preset = show::presetOf(*calibration);
  absl::StatusOr<v1::Display> display = makeDisplay(options);
  if (!display.ok()) return display;
  v1::QuiltDisplay& quilt = *display->mutable_quilt();
  quilt.set_aspect(double{1} * calibration->screen_px.width / calibration->screen_px.height);
  if (options.view_cone_deg == 0) {
    quilt.set_view_cone_rad(calibration->view_cone_deg * kRadPerDeg);
  }
  return display;
}

// Mode for displays without a calibrated panel: both eyes of a pair, or one view of many.
show::ShowMode plainMode(const v1::Display& display) {
  return display.has_stereo() ? show::ShowMode::kPair : show::ShowMode::kView;
}

// None is looked for where the views follow eyes.
absl::StatusOr<std::optional<Calibration>> calibrationOf(const ShowOptions& options) {
  if (!options.eye_file.empty()) return std::nullopt;
  return show::chooseCalibration(options.calibration_file, "/");
}

absl::StatusOr<show::SessionOptions> makeSession(const ShowOptions& options) {
  const auto calibration = calibrationOf(options);
  if (!calibration.ok()) return calibration.status();
  const bool is_panel = calibration->has_value();
  const absl::StatusOr<v1::Display> display = displayOf(options.display, *calibration);
  if (!display.ok()) return display.status();
  const absl::StatusOr<v1::AtlasEncoding> encoding = makeEncoding(options.display.encoding);
  if (!encoding.ok()) return encoding.status();
  const show::ShowMode usual = is_panel ? show::ShowMode::kNative : plainMode(*display);
  const show::ShowMode mode = show::modeNamed(options.mode).value_or(usual);
  if (!options.eye_file.empty()) {
    VIEWLOOM_RETURN_IF_ERROR(checkEyes(mode, *display));
  }
  VIEWLOOM_RETURN_IF_ERROR(checkMode(mode, is_panel));
  return show::SessionOptions{.stream = options.stream,
                              .display = *display,
                              .encoding = *encoding,
                              .calibration = *calibration,
                              .eye_file = options.eye_file,
                              .settings = {.mode = mode,
                                           .view = options.view,
                                           .pair_distance = options.pair_distance,
                                           .is_blended = options.views_between == "blend",
                                           .has_statistics = options.has_statistics},
                              .is_mode_open = options.mode.empty() && is_panel,
                              .monitor = options.monitor,
                              .is_windowed = options.is_windowed};
}

absl::Status tune(const ShowOptions& options, StatusLine& line) {
  VIEWLOOM_RETURN_IF_ERROR(checkOutput(options.out_file));
  const auto calibration = show::chooseCalibration(options.calibration_file, "/");
  if (!calibration.ok()) return calibration.status();
  if (!calibration->has_value()) {
    return absl::InvalidArgumentError(strCat("--tune", kNoPanel));
  }
  const InterruptLimit limit;
  return show::tunePanel(
      {.calibration = **calibration,
       .out = options.out_file,
       .monitor = options.monitor,
       .is_windowed = options.is_windowed},
      {.is_interrupted = &isInterrupted, .say = [&](const std::string& text) { line.say(text); }});
}

// The options given that shape a quilt: "--preset, --size".
std::string quiltOptions(const DisplayOptions& options) {
  const std::pair<const char*, bool> all[] = {{"--preset", !options.preset.empty()},
                                              {"--columns", options.columns > 0},
                                              {"--rows", options.rows > 0},
                                              {"--size", options.size_px.width > 0}};
  std::string names;
  for (const auto& [name, is_given] : all) {
    if (is_given) names += strCat(names.empty() ? "" : ", ", name);
  }
  return names;
}

absl::Status showOn(const ShowOptions& options, const CommonOptions& common, StatusLine& line) {
  const absl::StatusOr<show::SessionOptions> session = makeSession(options);
  if (!session.ok()) return session.status();
  const std::string unused = quiltOptions(options.display);
  if (session->settings.mode == show::ShowMode::kNative && !unused.empty()) {
    line.say(strCat("mode native does not use ", unused,
                    ": the panel's calibration says what its pixels show. For a quilt, give "
                    "--mode weave"));
  }
  const InterruptLimit limit;
  StreamWait waiting(line, common, options.stream);
  return show::showStream(channelTo(common), common.server, *session,
                          {.is_interrupted = &isInterrupted,
                           .say = [&](const std::string& text) { line.say(text); },
                           .on_connection = waiting.toldBefore(sayConnections(line, common))});
}

int run(const ShowOptions& options, const CommonOptions& common) {
  StatusLine line(true);
  const absl::Status status =
      options.is_tuning ? tune(options, line) : showOn(options, common, line);
  if (status.ok()) return kExitDone;
  const int exit_code = reportError(status, common);
  const bool is_usage = status.code() == absl::StatusCode::kInvalidArgument ||
                        status.code() == absl::StatusCode::kNotFound;
  return is_usage ? kExitUsage : exit_code;
}

}  // namespace

RunCommand addShowCommand(const usage::Command& app) {
  const auto options = std::make_shared<ShowOptions>();
  app.footer(
      "Keys: left/right view, up/down focal plane, [ ] cone, m mode, b blend, i statistics,\n"
      "      f full screen, escape or q ends\n"
      "Examples:\n"
      "  viewloom show                          show on the panel whose USB storage is plugged in\n"
      "  viewloom show --monitor 1 --calibration visual.json --mode weave\n"
      "  viewloom show --windowed --mode pair   show two views side by side in a window\n"
      "  head-tracker | viewloom show --display tracked.json --eyes-from -\n"
      "  viewloom show --tune --out visual.json adjust the calibration by eye");
  app.add("stream", options->stream, "Name of the stream").showDefault();
  app.add("--mode", options->mode,
          "How the stream is shown\n"
          "native  the server interlaces the views for a calibrated panel\n"
          "weave   this program interlaces the views of a quilt for the panel\n"
          "view    one view\n"
          "pair    two views side by side\n"
          "quilt   the whole quilt\n"
          "Calibrated panels default to weave if the server renders on a CPU,\n"
          "else to native. Stereo displays default to pair, others to view")
      .oneOf({"native", "weave", "view", "pair", "quilt"})
      .valueName("MODE");
  const usage::Option calibration =
      app.add("--calibration", options->calibration_file, "The panel's visual.json")
          .valueName("FILE")
          .defaultText("the one on its USB storage");
  const usage::Option eyes =
      app.add("--eyes-from", options->eye_file,
              "Eye positions for a tracked --display, in the format of `viewloom watch --eyes`; "
              "- reads a pipe")
          .valueName("FILE")
          .excludes(calibration);
  app.add("--monitor", options->monitor, "Number of the monitor")
      .defaultText("the monitor of the panel's size");
  app.addFlag("--windowed", options->is_windowed, "Show a window instead of the full screen");
  app.add("--view", options->view, "View to show first, counted from 0")
      .defaultText("the middle view");
  app.add("--pair-distance", options->pair_distance,
          "Distance between the two views of a pair, in views")
      .defaultText("an eighth of all views");
  app.add("--between-views", options->views_between,
          "Blend neighbouring views of a woven quilt, or show the nearest")
      .oneOf({"blend", "nearest"})
      .showDefault();
  app.addFlag("--statistics", options->has_statistics,
              "Print rate, dropped atlases and latency on the screen");
  const usage::Option tune =
      app.addFlag("--tune", options->is_tuning,
                  "Adjust pitch, slope and centre by eye; the screen lists the keys")
          .excludes(eyes)
          .group("Calibration");
  app.add("--out", options->out_file, "Calibration that --tune writes")
      .valueName("FILE")
      .needs(tune)
      .showDefault()
      .group("Calibration");
  addDisplayOptions(app, options->display);
  return [options](const CommonOptions& common) -> int { return run(*options, common); };
}

}  // namespace viewloom::cli
