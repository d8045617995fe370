// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"

#include <filesystem>
#include <memory>
#include <optional>
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
  app.addFlag("--synthetic", options.is_synthetic, "Publish the built-in moving scene")
      .group("What");
  addSizeOption(app, "--size", options.size_px, 8192,
                "Of the synthetic frames [960x540], of the pattern [1920x1080]")
      .group("What");
  app.add("--layers", options.layer_count,
          "Layers, 1..4: of the synthetic frames [2], at most of deep files [4]")
      .between(1, 4)
      .group("What");
  app.add("--sources", options.synthetic.source_count,
          "Cameras side by side that see the synthetic scene, 1..8 [1]")
      .between(1, 8)
      .group("What");
  app.addFlag("--cube", options.synthetic.is_cube_map,
              "The synthetic scene as a cube map: six square faces as high as --size")
      .excludes("--sources")
      .group("What");
  app.addFlag("--moving-camera", options.synthetic.has_moving_camera,
              "The synthetic scene from a camera that sways")
      .group("What");
  app.addFlag("--mirrors", options.synthetic.has_mirrors,
              "The synthetic scene with a lake and things of metal, for displays with reflections")
      .excludes("--sources")
      .excludes("--cube")
      .group("What");
  app.addFlag("--motion", options.synthetic.has_motion,
              "With how the things of the synthetic scene move, for displays with an output rate")
      .excludes("--cube")
      .group("What");
  app.add("--seconds", options.synthetic.duration_s,
          "Length of the synthetic scene, or how long the pattern stands; 0 = without end")
      .notNegative()
      .group("What");
  app.add("--replay", options.replay.file,
          "A recording of frames (--record), at its own times or at --rate")
      .group("What");
}

void addStreamOptions(const usage::Command& app, PublishOptions& options) {
  PublishRunOptions& run = options.run;
  app.add("--stream", run.stream, "Name of the stream").showDefault();
  app.add("--session", run.session_id,
          "Secret with which this publisher may take its stream over again [random]");
  const usage::Option rate =
      app.add("--fps,--rate", run.rate_hz, "Frames a second [15; of a recording: as recorded]")
          .between(0.001, 1000.0);
  app.add("--speed", options.replay.speed, "Replay so many times as fast as recorded [1]")
      .between(0.001, 1000.0)
      .needs("--replay")
      .excludes(rate);
  app.addFlag("--loop", options.is_looping, "Start again after the last file or recorded frame");
  app.addFlag("--hold", run.is_holding, "Keep the stream after the last frame, until Ctrl-C");
  app.add("--zstd", run.zstd_level, "Compress planes, level 1..19; for slow links; 0 = do not")
      .between(0, 19)
      .showDefault();
  app.add("--depth-encoding", run.depth_encoding,
          "plain (as it is), predicted (16-bit inverse depth, a tenth of the bytes, where its "
          "steps do not show), or auto: plain on this machine, else predicted")
      .oneOf({"auto", "plain", "predicted"})
      .showDefault();
  app.add("--record", run.record_file, "Keep the frames that are sent in this file");
  app.addFlag("--no-retry", run.has_no_retry, "End when the server cannot be reached");
  app.addFlag("-q,--quiet", run.is_quiet, "No status line");
}

absl::StatusOr<std::unique_ptr<FrameFeed>> makeReplay(const PublishOptions& options) {
  std::error_code ignored;
  if (std::filesystem::equivalent(options.replay.file, options.run.record_file, ignored)) {
    return absl::InvalidArgumentError(
        strCat("--record ", options.run.record_file, ": is what is replayed; name another file"));
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
        "--pattern has layers and a source of its own; leave out --layers, --sources, --cube, "
        "--moving-camera, --mirrors and --motion");
  }
  patterns::PatternOptions pattern = patternOptions(options.pattern);
  if (options.size_px.width > 0) pattern.size_px = options.size_px;
  auto feed = PatternFrames::make(options.pattern.name, pattern, options.synthetic.duration_s);
  if (!feed.ok()) return feed.status();
  return *std::move(feed);
}

absl::StatusOr<std::unique_ptr<FrameFeed>> makeFeed(const PublishOptions& options) {
  const int kinds = int{options.is_synthetic} + int{!options.pattern.name.empty()} +
                    int{!options.files.colors.empty()} + int{!options.files.deeps.empty()} +
                    int{!options.files.manifests.empty()} + int{!options.watched_folder.empty()} +
                    int{!options.replay.file.empty()};
  if (kinds != 1) {
    return absl::InvalidArgumentError(
        "what to publish? Accepted is one of --synthetic, --pattern, colour files, --deep, "
        "--manifest, --watch-folder, --replay");
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
    if (options.size_px.width > 0) synthetic.size_px = options.size_px;
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
      "  viewloom publish --pattern view-numbers --views 45 --cone 40\n"
      "  viewloom publish frame.exr --focal-px 1200 --hold\n"
      "  viewloom publish --deep comp.*.exr --layers 3 --fov 35 --loop\n"
      "  viewloom publish stereo.*.exr --view right --depth-far-zero --fps 24 --loop\n"
      "  viewloom publish photo.png --depth photo_mm.png --input sensor --fov 50 --hold\n"
      "  viewloom publish --watch-folder renders/ --fps 24\n"
      "  viewloom publish --synthetic --seconds 10 --zstd 1 --record scene.vlr\n"
      "  viewloom publish --replay scene.vlr --speed 0.5 --loop");
  addSourceOptions(app, *options);
  addPatternOptions(app, options->pattern);
  addFileOptions(app, options->files);
  app.add("--watch-folder", options->watched_folder,
          "Publish every complete file that is in this folder or comes into it; colour and "
          "depth in two files pair up by name, as x.png and x_depth.png")
      .group("What");
  addStreamOptions(app, *options);
  addPlaneOptions(app, options->files.loader.input);
  return [options](const CommonOptions& common) -> int {
    absl::StatusOr<std::unique_ptr<FrameFeed>> feed = makeFeed(*options);
    if (!feed.ok()) {
      reportError(feed.status(), common);
      return kExitUsage;
    }
    return runPublish(options->run, common, *std::move(feed));
  };
}

}  // namespace viewloom::cli
