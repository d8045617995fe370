// SPDX-License-Identifier: Apache-2.0
#include "offline/engine_commands.h"

#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/printable.h"
#include "base/str_cat.h"
#include "display/named_display.h"
#include "display/rgbd.h"
#include "files/file_bytes.h"
#include "frame/timing.h"
#include "offline/atlas_pictures.h"
#include "offline/compare_views.h"
#include "offline/manifest_frame.h"
#include "offline/shown_frame.h"
#include "usage/command_line.h"
#include "walk/offline_renderer.h"

namespace viewloom {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kExitRefused = 1;
const std::map<std::string, ScoreTransfer> kTransfers{{"srgb", ScoreTransfer::kSrgb},
                                                      {"gamma2.2", ScoreTransfer::kGamma22}};

struct RenderArguments {
  std::filesystem::path frame;
  std::filesystem::path before;
  std::optional<double> later_s;
  std::filesystem::path display;
  std::string preset;  // "" = the display is a file
  std::filesystem::path out;
  CompareOptions compare;
};

// For a person who waits, not for a log.
void showProgress(uint32_t done_rows, uint32_t row_count) {
  if (isatty(STDERR_FILENO) == 0) return;
  std::cerr << "\rrendered " << done_rows << " of " << row_count << " rows"
            << (done_rows == row_count ? "\n" : "") << std::flush;
}

Json coverageJson(const Coverage& coverage) {
  const auto share = [&](uint64_t count) {
    return static_cast<double>(count) / static_cast<double>(coverage.rayCount());
  };
  Json json;
  json["hit"] = share(coverage.hit);
  json["hit_assumed"] = share(coverage.hit_assumed);
  json["hidden"] = share(coverage.hidden);
  json["outside"] = share(coverage.outside);
  json["empty"] = share(coverage.empty);
  return json;
}

Json reflectionsJson(const ReflectionCounts& counts) {
  const auto share = [&](uint64_t count) {
    return static_cast<double>(count) / static_cast<double>(counts.rayCount());
  };
  Json json;
  json["hit"] = share(counts.hit);
  json["assumed"] = share(counts.assumed);
  json["back"] = share(counts.back);
  json["cube"] = share(counts.cube);
  json["environment"] = share(counts.environment);
  json["bent"] = share(counts.bent);
  return json;
}

Json sourceJson(const SourceStats& stats) {
  Json json;
  json["depth_step"] = stats.depth_step;
  json["noise_sigma"] = stats.noise_sigma;
  json["smoothing_reach"] = stats.smoothing_reach;
  json["connection_tolerance"] = stats.connection_tolerance;
  json["bad_samples"] = stats.bad_samples_count;
  json["unsorted_columns"] = stats.unsorted_columns_count;
  return json;
}

Json deepJson(const std::vector<files::DeepReport>& reports) {
  Json json = Json::array();
  for (const files::DeepReport& report : reports) {
    Json& one = json.emplace_back();
    one["file"] = report.file;
    one["layers"] = report.layer_count;
    one["samples"] = report.sample_count;
    one["dropped_samples"] = report.dropped_sample_count;
    one["samples_per_px_max"] = report.samples_per_px_max;
    one["pixels"] = report.pixel_count;
    one["merged"] = report.mergedShare();
    one["error_mean_per_m"] = report.error_mean_per_m;
    one["error_max_per_m"] = report.error_max_per_m;
  }
  return json;
}

// Messages about a file name it already; those about a field do not.
absl::Status inFile(const absl::Status& status, const std::filesystem::path& path) {
  return fieldOf(status).empty() ? status : withFieldPrefix(status, path.string());
}

// The same of the display, which a file or --preset gives.
absl::Status inDisplay(const absl::Status& status, const RenderArguments& arguments) {
  if (arguments.preset.empty()) return inFile(status, arguments.display);
  return inFile(status, strCat("--preset ", arguments.preset));
}

absl::StatusOr<DisplaySpec> readDisplay(const RenderArguments& arguments) {
  if (arguments.preset.empty()) return readDisplayFile(arguments.display);
  const absl::StatusOr<DisplayKind> named = namedDisplay(arguments.preset);
  if (!named.ok()) {
    // The field is "preset", which is an option here.
    return absl::Status(named.status().code(), strCat("--", named.status().message()));
  }
  return completeDisplaySpec({.kind = *named});
}

// Builds what a display with an output rate is shown at another time than the frame's own.
absl::StatusOr<Timing> buildBetween(const RenderArguments& arguments, const FramePtr& newest,
                                    const DisplaySpec& display, OfflineRenderer& renderer) {
  if (!display.temporal) {
    return inDisplay(invalidField("effects.temporal", "is missing, --later needs it"), arguments);
  }
  FramesAtHand frames{.newest = newest};
  if (!arguments.before.empty()) {
    const auto before = readManifestFrame(arguments.before);
    if (!before.ok()) return inFile(before.status(), arguments.before);
    frames.before = before->frame;
  }
  frames.inv_z_near = renderer.stats().front().inv_z_near;
  const auto shown = showBetween(frames, display, *arguments.later_s);
  if (!shown.ok()) return shown.status();
  renderer.build(*shown->frame, shown->source_pose);
  return shown->timing;
}

absl::StatusOr<Json> makeReport(const RenderArguments& arguments, const std::string& device_name) {
  const auto frame = readManifestFrame(arguments.frame);
  if (!frame.ok()) return inFile(frame.status(), arguments.frame);
  const auto display = readDisplay(arguments);
  if (!display.ok()) return inDisplay(display.status(), arguments);
  if (hasDepthPlane(*display)) {
    return inDisplay(invalidField("rgbd.depth_bits", "got 16, pictures of render have 8"),
                     arguments);
  }
  std::error_code failed;
  std::filesystem::create_directories(arguments.out, failed);
  if (failed) return files::refuseFile(arguments.out.string(), failed.message());

  const Device device({.select = device_name});
  OfflineRenderer renderer(device);
  renderer.build(*frame->frame);
  Json json;
  json["device"] = device.info().name;
  if (arguments.later_s) {
    const auto timing = buildBetween(arguments, frame->frame, *display, renderer);
    if (!timing.ok()) return timing.status();
    json["timing"] = timingText(*timing);
  }
  const TraceOutputs outputs = {
      .mask = true, .linear = !arguments.compare.truth.empty(), .records = true};
  const auto atlas = renderer.render(*display, outputs, showProgress);
  if (!atlas.ok()) return inDisplay(atlas.status(), arguments);
  const auto names = writeAtlasPictures(*atlas, arguments.out);
  if (!names.ok()) return names.status();

  const VisitStats visits = visitStats(*atlas);
  json["files"] = *names;
  json["coverage"] = coverageJson(atlas->coverage);
  if (atlas->reflections.rayCount() > 0) {
    json["reflections"] = reflectionsJson(atlas->reflections);
  }
  const std::vector<SourceStats> stats = renderer.stats();
  json["source"] = sourceJson(stats.front());
  for (size_t i = 1; i < stats.size(); ++i) json["more_sources"].push_back(sourceJson(stats[i]));
  if (!frame->deep.empty()) json["deep"] = deepJson(frame->deep);
  json["visits"] = {{"mean", visits.mean}, {"p99", visits.p99}, {"max", visits.max}};
  if (!arguments.compare.truth.empty()) {
    auto views = compareViews(*atlas, arguments.compare);
    if (!views.ok()) return inFile(views.status(), arguments.compare.truth);
    json["views"] = *std::move(views);
  }
  return json;
}

int render(const RenderArguments& arguments, const Config& config) {
  // A file that reaches the largest size allowed is a failed write, not the end of the command.
  std::signal(SIGXFSZ, SIG_IGN);
  const absl::StatusOr<Json> json = makeReport(arguments, config.device);
  if (!json.ok()) {
    std::cerr << "viewloom render: "
              << printable({json.status().message().data(), json.status().message().size()}, true)
              << "\n";
    return kExitRefused;
  }
  // Names of files may hold any bytes.
  std::cout << json->dump(2, ' ', true, Json::error_handler_t::replace) << "\n";
  return 0;
}

}  // namespace

namespace cli {

RunCommand addRenderCommand(const usage::Command& command) {
  const auto arguments = std::make_shared<RenderArguments>();
  CompareOptions& compare = arguments->compare;
  command.footer(
      "The report is JSON on standard output.\n"
      "Examples:\n"
      "  viewloom render --frame frame.json --preset portrait --out views\n"
      "  viewloom render --frame frame.json --display two.json --out views --compare truth.json");
  command.add("--frame", arguments->frame, "Manifest of the frame, in JSON")
      .valueName("FILE")
      .required();
  const usage::Option later =
      command
          .add("--later", arguments->later_s,
               "Render this time after the frame, for a display with effects.temporal; "
               "negative times interpolate")
          .valueName("SECONDS")
          .defaultText("the frame's own time");
  command
      .add("--before", arguments->before,
           "Manifest of the previous frame, in JSON, from which the camera moves")
      .valueName("FILE")
      .needs(later);
  const usage::Command display = command.addAlternatives("Display");
  display.add("--display", arguments->display, "Display of any kind, as a JSON file")
      .valueName("FILE");
  display
      .add("--preset", arguments->preset,
           "Name of a known device; `viewloom list presets` lists them")
      .valueName("NAME");
  command.add("--out", arguments->out, "Folder for the pictures; it is created if missing")
      .valueName("FOLDER")
      .required();
  const usage::Option truth =
      command
          .add("--compare", compare.truth,
               "Manifest of true views, in JSON, with which the views are compared")
          .valueName("FILE");
  command
      .addWord("--transfer", compare.transfer, kTransfers,
               "Transfer function of the compared numbers")
      .defaultText("srgb")
      .needs(truth);
  command.add("--border", compare.border_px, "Pixels to leave out on each side of a compared view")
      .showDefault()
      .needs(truth);
  command
      .add("--covered-mask", compare.covered_masks,
           "One 8-bit grey PNG per true view: 255 is covered, 0 hidden, others outside")
      .valueName("FILE")
      .needs(truth);
  return withEngineSettings(
      command, {"device", "validation", "log."},
      [arguments](const Config& config) { return render(*arguments, config); });
}

}  // namespace cli
}  // namespace viewloom
