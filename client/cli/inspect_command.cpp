// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/output_file.h"
#include "base/str_cat.h"
#include "cli/display_options.h"
#include "cli/file_frames.h"
#include "cli/inspection_report.h"
#include "cli/option_trial.h"
#include "cli/plane_options.h"
#include "cli/report_error.h"
#include "files/container.h"
#include "files/exr_description.h"
#include "files/file_bytes.h"
#include "files/png_image.h"

namespace viewloom::cli {
namespace {

struct InspectOptions {
  FileFeedOptions files;
  DisplayOptions display;
  uint32_t layer_count = 0;
  std::string picture;
  bool as_json = false;
};

// Files are named in one list, whatever they are: manifests and deep files tell themselves.
void sortFiles(FileFeedOptions& options) {
  if (!options.depths.empty()) return;
  for (std::string& file : std::exchange(options.colors, {})) {
    if (files::hasExtension(file, ".json")) {
      options.manifests.push_back(std::move(file));
      continue;
    }
    bool is_deep = false;
    if (files::isExr(file)) {
      const absl::StatusOr<files::ExrDescription> description = files::describeExr(file);
      // A file that cannot be read is reported when its turn comes.
      is_deep = description.ok() && description->isDeep();
    }
    (is_deep ? options.deeps : options.colors).push_back(std::move(file));
  }
}

absl::StatusOr<InspectedFile> inspectFiles(const FrameFiles& files, FrameLoader& loader,
                                           const LoaderOptions& options,
                                           const std::optional<v1::Display>& display) {
  InspectedFile inspected{.file = files.name()};
  absl::StatusOr<std::string> format = describeFormat(files.name());
  if (!format.ok()) return format.status();
  inspected.format = *std::move(format);
  absl::StatusOr<LoadedFiles> loaded = loader.load(files);
  if (!loaded.ok()) return loaded.status();
  inspected.loaded = *std::move(loaded);
  auto sources = inspect::inspectFrame(inspected.loaded.frame);
  if (!sources.ok()) return sources.status();
  inspected.sources = *std::move(sources);
  tryRemedies(OptionTrial(files, options), inspected.sources);
  const bool is_stated =
      !files.manifest.empty() ||
      (inspected.loaded.how && inspected.loaded.how->source.camera().has_intrinsics());
  const bool sees_all = inspected.loaded.frame.wire.header.sources(0).cube_map();
  inspected.camera_is_assumed =
      !sees_all && !is_stated && !options.input.fov_y_deg && !options.input.focal_px;
  if (display) {
    absl::StatusOr<DisplayNeed> need = displayNeed(
        *display, inspected.loaded.frame.wire.header.sources(0), inspected.sources.front());
    if (!need.ok()) return need.status();
    inspected.need = *std::move(need);
  }
  return inspected;
}

absl::Status writePicture(const InspectedFile& inspected, const std::string& path) {
  const auto picture = inspect::drawInspection(inspected.sources.front().layers.front(),
                                               *inspected.loaded.frame.wire.planes.front());
  if (!picture.ok()) return picture.status();
  const auto png = files::encodePng(picture->rgb, picture->width_px, picture->height_px, 3);
  if (!png.ok()) return png.status();
  return files::writeFileWhole(path, *png);
}

int inspectAll(const InspectOptions& options, const std::vector<FrameFiles>& frames,
               const CommonOptions& common) {
  FrameLoader loader(options.files.loader);
  nlohmann::json reports = nlohmann::json::array();
  int exit_code = kExitDone;
  bool has_picture = options.picture.empty();
  std::optional<v1::Display> display;
  if (isGiven(options.display)) {
    absl::StatusOr<v1::Display> made = makeDisplay(options.display);
    if (!made.ok()) {
      reportError(made.status(), common);
      return kExitUsage;
    }
    display = *std::move(made);
  }
  for (const FrameFiles& files : frames) {
    const auto inspected = inspectFiles(files, loader, options.files.loader, display);
    if (!inspected.ok()) {
      reportError(inspected.status(), common);
      exit_code = kExitUsage;
      continue;
    }
    if (!std::exchange(has_picture, true)) {
      if (absl::Status written = writePicture(*inspected, options.picture); !written.ok()) {
        return reportError(written, common);
      }
    }
    if (options.as_json) {
      reports.push_back(reportJson(*inspected));
    } else {
      std::fputs(reportText(*inspected).c_str(), stdout);
    }
  }
  if (options.as_json) std::printf("%s\n", jsonText(reports).c_str());
  return exit_code;
}

int inspect(const InspectOptions& options, const CommonOptions& common) {
  if (!options.picture.empty()) {
    if (const absl::Status place = checkOutput(options.picture); !place.ok()) {
      reportError(place, common);
      return kExitUsage;
    }
  }
  InspectOptions sorted = options;
  sorted.files.loader.deep_layer_count_max = options.layer_count;
  sortFiles(sorted.files);
  absl::StatusOr<std::vector<FrameFiles>> frames = framesOf(sorted.files);
  if (frames.ok() && frames->empty()) {
    frames = absl::InvalidArgumentError(
        "no file is given. Name image files or manifests, for example `viewloom inspect "
        "frame.exr`");
  }
  if (!frames.ok()) {
    reportError(frames.status(), common);
    return kExitUsage;
  }
  return inspectAll(sorted, *frames, common);
}

}  // namespace

RunCommand addInspectCommand(const usage::Command& app) {
  const auto options = std::make_shared<InspectOptions>();
  app.footer(
      "Examples:\n"
      "  viewloom inspect render.0001.exr --picture look.png\n"
      "  viewloom inspect render.0001.exr --preset portrait --cone 50\n"
      "  viewloom inspect photo.png --depth depth.png --input relative --depth-near 0.8 "
      "--depth-far 12\n"
      "  viewloom inspect holiday_rgbd.png --input rgbd --depth-near 1 --depth-far inf --json");
  addFileOptions(app, options->files);
  app.add("--layers", options->layer_count, "Most layers of a deep file, 1 to 4")
      .between(1, 4)
      .defaultText("4")
      .group("Content");
  app.add("--picture", options->picture,
          "Save colour and depth of the first frame as a PNG; white is near, magenta is no surface")
      .valueName("FILE");
  app.addFlag("--json", options->as_json, "Print the report as JSON, one entry per frame");
  addPlaneOptions(app, options->files.loader.input);
  addDisplayShape(app, options->display);
  addPanelOptions(app, options->display);
  return [options](const CommonOptions& common) { return inspect(*options, common); };
}

}  // namespace viewloom::cli
