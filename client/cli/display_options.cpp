// SPDX-License-Identifier: Apache-2.0
#include "cli/display_options.h"

#include <numbers>
#include <optional>
#include <utility>
#include <variant>

#include "base/str_cat.h"
#include "cli/bounded_options.h"
#include "display/named_display.h"
#include "files/file_bytes.h"
#include "files/json_message.h"
#include "messages/message_from_json.h"

namespace viewloom::cli {
namespace {

constexpr uint64_t kDisplayBytesMax = uint64_t{4} << 20;  // 1024 cameras take less than 1 MiB
constexpr uint64_t kCalibrationBytesMax = uint64_t{64} << 10;
constexpr double kRadPerDeg = std::numbers::pi / 180;

// A file, or the message itself, which begins with a brace.
absl::StatusOr<v1::Display> readDisplay(const std::string& given) {
  v1::Display display;
  if (given.starts_with('{')) {
    VIEWLOOM_RETURN_IF_ERROR(
        withFieldPrefix(messageFromJson(given, kDisplayBytesMax, display), "--display"));
  } else {
    VIEWLOOM_RETURN_IF_ERROR(files::readJsonMessage(given, kDisplayBytesMax, "a display", display));
  }
  return display;
}

}  // namespace

usage::Option addDisplayShape(const usage::Command& app, DisplayOptions& options) {
  const char* const group = "Display";
  const usage::Option file =
      app.add("--display", options.file,
              "Display of any kind, as a JSON file or as JSON itself; replaces the other options "
              "of the display")
          .valueName("FILE|JSON")
          .group(group);
  app.add("--preset", options.preset, "Name of a known device; `viewloom list presets` lists them")
      .valueName("NAME")
      .defaultText("portrait")
      .excludes(file)
      .group(group);
  within(app.add("--columns", options.columns, "Columns of the quilt, 1 to 50"), "quilt.columns")
      .defaultText("the preset's")
      .excludes(file)
      .group(group);
  within(app.add("--rows", options.rows, "Rows of the quilt, 1 to 50"), "quilt.rows")
      .defaultText("the preset's")
      .excludes(file)
      .group(group);
  addSizeOption(app, "--size", options.size_px, sideMax("quilt.size.width"),
                "Size of the whole quilt in pixels, up to 16384 per side")
      .defaultText("the preset's")
      .excludes(file)
      .group(group);
  app.add("--cone", options.view_cone_deg, "Angle between the outermost views, up to 148")
      .valueName("DEGREES")
      .defaultText("the preset's, else 40")
      .excludes(file)
      .group(group);
  app.add("--focal-distance", options.focal_distance_m,
          "Distance of the focal plane, which has no parallax")
      .valueName("METRES")
      .defaultText("from the content")
      .excludes(file)
      .group(group);
  return file;
}

void addDisplayOptions(const usage::Command& app, DisplayOptions& options) {
  const char* const group = "Display";
  const usage::Option file = addDisplayShape(app, options);
  within(app.add("--focus-follow", options.focus_following_s,
                 "Let the focal plane follow the content: time for 63 % of the way, 0.01 to 60"),
         "focus_following_s")
      .valueName("SECONDS")
      .defaultText("it stays")
      .excludes(file)
      .group(group);
  app.add("--fov", options.fov_y_deg, "Vertical field of view of each view, up to 148")
      .valueName("DEGREES")
      .defaultText("the source's")
      .excludes(file)
      .group(group);
  within(app.add("--samples", options.sample_count,
                 "Rays per pixel against aliasing and crosstalk, 1 to 16"),
         "filter.sample_count")
      .showDefault()
      .excludes(file)
      .group(group);
  addLensOptions(app, options.lens, file);
  addTemporalOptions(app, options.temporal, file);
  within(app.add("--reflections", options.bounce_count,
                 "Show reflections, with up to this many bounces per ray, 1 to 4"),
         "effects.reflection.bounces")
      .defaultText("no reflections")
      .excludes(file)
      .group(group);
  addEncodingOptions(app, options.encoding);
}

void addPanelOptions(const usage::Command& app, DisplayOptions& options) {
  app.addFlag("--native", options.is_native,
              "Receive the pixels of the preset's panel, interlaced by the server")
      .group("Display");
  app.add("--calibration", options.calibration_file,
          "Receive the pixels of the panel of this visual.json")
      .valueName("FILE")
      .group("Display");
}

void addDepthDisplayOptions(const usage::Command& app, DisplayOptions& options) {
  std::vector<usage::Option> others;
  for (const char* name : {"--display", "--columns", "--rows", "--size", "--cone",
                           "--focal-distance", "--native", "--calibration"}) {
    if (const auto other = app.find(name)) others.push_back(*other);
  }
  addRgbdOptions(app, options.rgbd, others);
}

namespace {

absl::StatusOr<v1::LenticularDisplay> makeLenticular(const DisplayOptions& options) {
  v1::LenticularDisplay lenticular;
  lenticular.set_preset(
      options.preset.empty() && options.calibration_file.empty() ? "portrait" : options.preset);
  if (!options.calibration_file.empty()) {
    const absl::StatusOr<std::vector<uint8_t>> bytes =
        files::readFileBytes(options.calibration_file, kCalibrationBytesMax);
    if (!bytes.ok()) return bytes.status();
    lenticular.set_calibration_json(std::string(bytes->begin(), bytes->end()));
  }
  lenticular.set_view_cone_rad(options.view_cone_deg * kRadPerDeg);
  lenticular.set_focal_distance_m(options.focal_distance_m);
  lenticular.set_fov_y_rad(options.fov_y_deg * kRadPerDeg);
  return lenticular;
}

v1::QuiltDisplay makeQuilt(const DisplayOptions& options) {
  v1::QuiltDisplay quilt;
  const bool is_complete = options.columns > 0 && options.rows > 0 && options.size_px.width > 0;
  quilt.set_preset(options.preset.empty() && !is_complete ? "portrait" : options.preset);
  quilt.set_columns(options.columns);
  quilt.set_rows(options.rows);
  if (options.size_px.width > 0) {
    quilt.mutable_size()->set_width(options.size_px.width);
    quilt.mutable_size()->set_height(options.size_px.height);
  }
  quilt.set_view_cone_rad(options.view_cone_deg * kRadPerDeg);
  quilt.set_focal_distance_m(options.focal_distance_m);
  quilt.set_fov_y_rad(options.fov_y_deg * kRadPerDeg);
  return quilt;
}

// Display of a device that takes no quilts; empty for other names.
std::optional<DisplayKind> deviceWithoutQuilts(const DisplayOptions& options) {
  if (options.preset.empty()) return std::nullopt;
  absl::StatusOr<DisplayKind> named = namedDisplay(options.preset);
  if (!named.ok() || std::holds_alternative<QuiltSpec>(*named)) return std::nullopt;
  return *std::move(named);
}

// Refuses options that only quilts and lenticular panels take.
absl::Status refuseShapeOptions(const DisplayOptions& options) {
  const std::pair<const char*, bool> shape_options[] = {
      {"--columns", options.columns > 0},
      {"--rows", options.rows > 0},
      {"--size", options.size_px.width > 0},
      {"--cone", options.view_cone_deg != 0},
      {"--focal-distance", options.focal_distance_m != 0},
      {"--focus-follow", options.focus_following_s != 0},
      {"--calibration", !options.calibration_file.empty()}};
  for (const auto& [name, is_given] : shape_options) {
    if (!is_given) continue;
    return absl::InvalidArgumentError(
        strCat(name, " works with quilts and lenticular panels, and --preset ", options.preset,
               " is neither. Leave out ", name, ", or name a quilt from `viewloom list presets`"));
  }
  return absl::OkStatus();
}

absl::Status setDevice(const DisplayKind& kind, const DisplayOptions& options,
                       v1::Display& display) {
  VIEWLOOM_RETURN_IF_ERROR(refuseShapeOptions(options));
  if (std::holds_alternative<RgbdSpec>(kind)) {
    display.mutable_rgbd()->set_preset(options.preset);
    display.mutable_rgbd()->set_fov_y_rad(options.fov_y_deg * kRadPerDeg);
    return absl::OkStatus();
  }
  display.set_preset(options.preset);
  if (options.fov_y_deg == 0) return absl::OkStatus();
  return absl::InvalidArgumentError(strCat("--fov: the lenses of --preset ", options.preset,
                                           " set the field of view. Leave out --fov"));
}

bool isNative(const DisplayOptions& options) {
  return options.is_native || !options.calibration_file.empty();
}

// Whether the name alone says what the display is, and this program does not know it. The server
// opens it, or answers with the nearest names of every kind.
bool isForServer(const DisplayOptions& options) {
  return !options.preset.empty() && !namedDisplay(options.preset).ok() && !options.is_native &&
         options.fov_y_deg == 0 && refuseShapeOptions(options).ok();
}

}  // namespace

bool isGiven(const DisplayOptions& options) {
  return !options.file.empty() || !options.preset.empty() || options.columns > 0 ||
         options.rows > 0 || options.size_px.width > 0 || options.view_cone_deg != 0 ||
         options.focal_distance_m != 0 || isNative(options);
}

bool hasOwnFov(const DisplayOptions& options) {
  const std::optional<DisplayKind> kind = deviceWithoutQuilts(options);
  return !options.file.empty() || options.fov_y_deg != 0 ||
         (kind && std::holds_alternative<IntegralSpec>(*kind));
}

absl::StatusOr<v1::Display> makeDisplay(const DisplayOptions& options) {
  if (!options.file.empty()) return readDisplay(options.file);
  v1::Display display;
  display.mutable_filter()->set_sample_count(options.sample_count);
  setLens(options.lens, display);
  setTemporal(options.temporal, display);
  if (options.bounce_count > 0) {
    display.mutable_effects()->mutable_reflection()->set_bounces(options.bounce_count);
  }
  if (options.rgbd.view_size_px.width > 0) {
    *display.mutable_rgbd() = makeRgbd(options.rgbd, options.fov_y_deg * kRadPerDeg);
    display.mutable_rgbd()->set_preset(options.preset);
    return display;
  }
  if (const auto kind = deviceWithoutQuilts(options)) {
    VIEWLOOM_RETURN_IF_ERROR(setDevice(*kind, options, display));
    return display;
  }
  if (isForServer(options)) {
    display.set_preset(options.preset);
    return display;
  }
  display.set_focus_following_s(options.focus_following_s);
  if (!isNative(options)) {
    *display.mutable_quilt() = makeQuilt(options);
    return display;
  }
  absl::StatusOr<v1::LenticularDisplay> lenticular = makeLenticular(options);
  if (!lenticular.ok()) return lenticular.status();
  *display.mutable_lenticular() = *std::move(lenticular);
  return display;
}

}  // namespace viewloom::cli
