// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "base/str_cat.h"
#include "cli/bounded_options.h"
#include "cli/file_frames.h"
#include "cli/folder_frames.h"
#include "cli/pattern_frames.h"
#include "cli/plane_options.h"
#include "cli/publish_run.h"
#include "cli/replayed_frames.h"
#include "cli/report_error.h"
#include "cli/synthetic_frames.h"
#include "usage/command_line.h"
#include "video/quantisation.h"

namespace viewloom::cli {
namespace {

struct PublishOptions {
  bool is_synthetic = false;
  std::optional<uint32_t> layer_count;
  SizePx size_px;  // 0 x 0 = what the built-in scene or pattern has by default
  SyntheticFeedOptions synthetic;
  PatternFeedOptions pattern;
  FileFeedOptions files;
  std::string watched_folder;
  ReplayOptions replay;
  bool is_looping = false;
  PublishRunOptions run;
};

void addSourceOptions(const usage::Command& app, PublishOptions& options) {
  app.addFlag("--synthetic", options.is_synthetic, "Publish a built-in moving scene")
      .group("Content");
  app.addWord(
         "--scene", options.synthetic.setting,
         std::map<std::string, synthetic::Setting>{{"balls", synthetic::Setting::kBalls},
                                                   {"portrait", synthetic::Setting::kPortrait}},
         "Which built-in scene: balls is wide, portrait is for displays of 3:4 and stands for 5 s "
         "of each 20 s")
      .defaultText("balls")
      .needs("--synthetic")
      .group("Content");
  addSizeOption(app, "--size", options.size_px, 8192,
                "Size of the synthetic frames or of the test pattern, in pixels")
      .defaultText("960x540, scene portrait 720x960, pattern 1920x1080")
      .group("Content");
  app.add("--layers", options.layer_count,
          "Layers of the synthetic frames, or most layers of a deep file, 1 to 4")
      .between(1, 4)
      .defaultText("2, deep files 4")
      .group("Content");
  app.add("--sources", options.synthetic.source_count,
          "Cameras that see the synthetic scene side by side, 1 to 8")
      .between(1, 8)
      .defaultText("1")
      .group("Content");
  app.addFlag("--cube", options.synthetic.is_cube_map,
              "Publish the synthetic scene as a cube map: six square faces, as high as --size")
      .excludes("--sources")
      .group("Content");
  app.addFlag("--moving-camera", options.synthetic.has_moving_camera,
              "Let the camera of the synthetic scene sway")
      .group("Content");
  app.addFlag("--mirrors", options.synthetic.has_mirrors,
              "Add a shiny floor and metal objects to the synthetic scene, for displays with "
              "reflections")
      .excludes("--sources")
      .excludes("--cube")
      .group("Content");
  app.addFlag("--motion", options.synthetic.has_motion,
              "Publish how the synthetic objects move, for displays with an output rate")
      .excludes("--cube")
      .group("Content");
  app.add("--seconds", options.synthetic.duration_s,
          "Length of the synthetic scene or of the test pattern; 0 never ends")
      .valueName("SECONDS")
      .notNegative()
      .defaultText("0")
      .group("Content");
  app.add("--replay", options.replay.file,
          "Replay a recording of frames (--record), with its own timing or at --rate")
      .valueName("FILE")
      .group("Content");
}

void addEncodingOptions(const usage::Command& app, PublishRunOptions& run) {
  const char* const group = "Stream";
  app.add("--zstd", run.zstd_level,
          "Level of zstd compression, 1 to 19, for slow networks; 0 is off")
      .valueName("LEVEL")
      .between(0, 19)
      .showDefault()
      .group(group);
  app.add("--depth-encoding", run.depth_encoding,
          "How depth is sent\n"
          "plain      unchanged\n"
          "predicted  as 16-bit inverse depth (1/Z), in about a tenth of the bytes;\n"
          "           unchanged if its steps would show\n"
          "auto       plain to a server on this machine, else predicted")
      .oneOf({"auto", "plain", "predicted"})
      .showDefault()
      .group(group);
  app.add("--color-encoding", run.color_encoding,
          "How colour is sent\n"
          "plain      unchanged\n"
          "video      as H.264, in a twentieth of the bytes or less;\n"
          "           errors are small\n"
          "auto       plain to a server on this machine, and for replays and\n"
          "           patterns; else video for pictures of at least 256x256 px")
      .oneOf({"auto", "plain", "video"})
      .showDefault()
      .group(group);
  app.add("--color-qp", run.color_qp,
          strCat("Quantisation of colour as video, ", kVideoQpMin, " to ", kVideoQpMax,
                 "; less is better, and takes more bytes"))
      .valueName("QP")
      .between(kVideoQpMin, kVideoQpMax)
      .showDefault()
      .group(group);
}

void addStreamOptions(const usage::Command& app, PublishOptions& options) {
  const char* const group = "Stream";
  PublishRunOptions& run = options.run;
  app.add("--stream", run.stream, "Name of the stream")
      .valueName("NAME")
      .showDefault()
      .group(group);
  app.add("--session", run.session_id,
          "Secret with which a restarted publisher takes over its own stream")
      .valueName("SECRET")
      .defaultText("random")
      .group(group);
  const usage::Option rate =
      app.add("--fps,--rate", run.rate_hz, "Frames per second, 0.001 to 1000")
          .valueName("HZ")
          .between(0.001, 1000.0)
          .defaultText("15, replay as recorded")
          .group(group);
  app.add("--speed", options.replay.speed,
          "Replay this many times as fast as recorded, 0.001 to 1000")
      .valueName("FACTOR")
      .between(0.001, 1000.0)
      .defaultText("1")
      .group(group)
      .needs("--replay")
      .excludes(rate);
  app.addFlag("--loop", options.is_looping, "Start again after the last file or recorded frame")
      .group(group);
  app.addFlag("--hold", run.is_holding, "Keep the stream open after the last frame, until Ctrl-C")
      .group(group);
  addEncodingOptions(app, run);
  app.add("--record", run.record_file, "Record the sent frames in this file")
      .valueName("FILE")
      .group(group);
  app.addFlag("--no-retry", run.has_no_retry,
              "End if the server cannot be reached, instead of trying again")
      .group(group);
  app.addFlag("-q,--quiet", run.is_quiet, "Print no status line").group(group);
}

absl::StatusOr<std::unique_ptr<FrameFeed>> makeReplay(const PublishOptions& options) {
  std::error_code ignored;
  if (std::filesystem::equivalent(options.replay.file, options.run.record_file, ignored)) {
    return absl::InvalidArgumentError(strCat("--record ", options.run.record_file,
                                             ": this file is being replayed. Name another file"));
  }
  ReplayOptions replay = options.replay;
  replay.rate_hz = options.run.rate_hz;
  replay.is_looping = options.is_looping;
  return ReplayedFrames::open(std::move(replay));
}

absl::StatusOr<std::unique_ptr<FrameFeed>> makePatternFeed(const PublishOptions& options) {
  const SyntheticFeedOptions& synthetic = options.synthetic;
  if (options.layer_count || synthetic.source_count != 1 || synthetic.is_cube_map ||
      synthetic.has_moving_camera || synthetic.has_mirrors || synthetic.has_motion) {
    return absl::InvalidArgumentError(
        "--pattern has its own layers and camera. Leave out --layers, --sources, --cube, "
        "--moving-camera, --mirrors and --motion");
  }
  patterns::PatternOptions pattern = patternOptions(options.pattern);
  if (options.size_px.width > 0) pattern.size_px = options.size_px;
  auto feed = PatternFrames::make(options.pattern.name, pattern, options.synthetic.duration_s);
  if (!feed.ok()) return feed.status();
  return *std::move(feed);
}

// Replays repeat bytes, and patterns judge displays: neither is changed unless it is asked for.
bool changesNoColor(const PublishOptions& options) {
  return !options.replay.file.empty() || !options.pattern.name.empty();
}

absl::StatusOr<std::unique_ptr<FrameFeed>> makeFeed(const PublishOptions& options) {
  const int kinds = int{options.is_synthetic} + int{!options.pattern.name.empty()} +
                    int{!options.files.colors.empty()} + int{!options.files.deeps.empty()} +
                    int{!options.files.manifests.empty()} + int{!options.watched_folder.empty()} +
                    int{!options.replay.file.empty()};
  if (kinds != 1) {
    return absl::InvalidArgumentError(strCat(
        kinds == 0 ? "nothing to publish is named" : "more than one thing to publish is named",
        ". Name exactly one: --synthetic, --pattern, colour files, --deep, --manifest, "
        "--watch-folder or --replay"));
  }
  const std::string made = options.is_synthetic            ? "--synthetic"
                           : !options.pattern.name.empty() ? "--pattern"
                           : !options.replay.file.empty()  ? "--replay"
                                                           : "";
  if (!made.empty()) VIEWLOOM_RETURN_IF_ERROR(refuseFileOptions(options.files, made));
  if (!options.replay.file.empty()) return makeReplay(options);
  if (!options.pattern.name.empty()) return makePatternFeed(options);
  if (options.is_synthetic) {
    SyntheticFeedOptions synthetic = options.synthetic;
    synthetic.size_px = options.size_px;
    synthetic.layer_count = options.layer_count.value_or(synthetic.layer_count);
    return std::make_unique<SyntheticFrames>(synthetic);
  }
  FileFeedOptions files = options.files;
  files.is_looping = options.is_looping;
  files.loader.deep_layer_count_max = options.layer_count.value_or(0);
  if (!options.watched_folder.empty()) {
    auto folder = FolderFrames::open(options.watched_folder, files.loader, files.view);
    if (!folder.ok()) return folder.status();
    return *std::move(folder);
  }
  absl::StatusOr<std::vector<FrameFiles>> frames = framesOf(files);
  if (!frames.ok()) return frames.status();
  return std::make_unique<FileFrames>(files, *std::move(frames));
}

}  // namespace

RunCommand addPublishCommand(const usage::Command& app) {
  const auto options = std::make_shared<PublishOptions>();
  app.footer(
      "Examples:\n"
      "  viewloom publish --synthetic --size 1280x720 --layers 3\n"
      "  viewloom publish frame.exr --focal-px 1200 --hold\n"
      "  viewloom publish photo.png --depth photo_mm.png --input sensor --fov 50 --hold\n"
      "  viewloom publish --watch-folder renders/ --fps 24\n"
      "  viewloom publish --deep comp.*.exr --layers 3 --fov 35 --loop\n"
      "  viewloom publish stereo.*.exr --view right --depth-far-zero --fps 24 --loop\n"
      "  viewloom publish --pattern view-numbers --views 45 --cone 40\n"
      "  viewloom publish --synthetic --seconds 10 --zstd 1 --record scene.vlr\n"
      "  viewloom publish --replay scene.vlr --speed 0.5 --loop");
  addSourceOptions(app, *options);
  addPatternOptions(app, options->pattern);
  addFileOptions(app, options->files);
  app.add("--watch-folder", options->watched_folder,
          "Publish each complete picture in this folder, now and later; x.png pairs with "
          "x_depth.png")
      .valueName("FOLDER")
      .group("Content");
  addStreamOptions(app, *options);
  addPlaneOptions(app, options->files.loader.input);
  return [options](const CommonOptions& common) -> int {
    absl::StatusOr<std::unique_ptr<FrameFeed>> feed = makeFeed(*options);
    if (!feed.ok()) {
      reportError(feed.status(), common);
      return kExitUsage;
    }
    PublishRunOptions run = options->run;
    if (run.color_encoding == "auto" && changesNoColor(*options)) run.color_encoding = "plain";
    return runPublish(run, common, *std::move(feed));
  };
}

}  // namespace viewloom::cli
