// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "base/str_cat.h"
#include "cli/atlas_outputs.h"
#include "cli/display_options.h"
#include "cli/eye_times.h"
#include "cli/frame_feed.h"
#include "cli/interrupt.h"
#include "cli/outside_text.h"
#include "cli/recorded_atlases.h"
#include "cli/report_error.h"
#include "cli/server_options.h"
#include "cli/status_line.h"
#include "cli/stream_wait.h"
#include "cli/watch_words.h"
#include "eyes/eye_feed.h"
#include "lib/latency.h"
#include "lib/preferred_video.h"
#include "lib/watcher.h"
#include "usage/command_line.h"

namespace viewloom::cli {
namespace {

struct WatchOptions {
  std::string stream = "demo";
  std::string recording;  // "" = watch the stream
  DisplayOptions display;
  std::string eye_file;  // "" = the eyes are the display's own
  std::string folder;
  bool writes_views = false;
  std::string format = "jpg";
  AtlasOutputOptions output;  // its video
  uint32_t count = 0;
  bool fails_without_stream = false;
  bool has_no_retry = false;
  bool is_quiet = false;
};

class WatchRun {
 public:
  WatchRun(const WatchOptions& options, const CommonOptions& common)
      : options_(options), common_(common), line_(options.is_quiet) {}

  int run() {
    if (!options_.recording.empty()) return runRecording();
    auto outputs = AtlasOutputs::open(outputOptions(options_.stream), line_);
    if (!outputs.ok()) return usage(outputs.status());
    outputs_ = *std::move(outputs);
    const absl::StatusOr<v1::Display> display = makeDisplay(options_.display);
    if (!display.ok()) return usage(display.status());
    const absl::StatusOr<v1::AtlasEncoding> encoding = makeEncoding(options_.display.encoding);
    if (!encoding.ok()) return usage(encoding.status());
    v1::OpenDisplay open;
    open.set_stream(options_.stream);
    *open.mutable_display() = *display;
    *open.mutable_encoding() = *encoding;
    if (!outputOptions(options_.stream).keepsJpeg()) preferVideo(common_.server, open);
    open.set_count(options_.count);
    open.set_wait_for_stream(!options_.fails_without_stream);
    if (absl::Status eyes = openEyes(*display); !eyes.ok()) return usage(eyes);
    outputs_->beginInterruptible();
    waiting_.emplace(line_, common_, options_.stream);
    watcher_ = std::make_unique<Watcher>(channelTo(common_), open, callbacks());
    // Only the line says how the server's clock stands: who sees none need not ask.
    if (!options_.is_quiet) clock_ = std::make_unique<ClockFollower>(*watcher_);
    if (eyes_) eyes_->start(eyeCallbacks());
    while (!watcher_->waitEnded(kInterruptTick_ns) && !isInterrupted() && failure().ok()) {
      if (line_.isDue()) line_.show(status());
    }
    return end();
  }

 private:
  int usage(const absl::Status& status) const {
    reportError(status, common_);
    return kExitUsage;
  }

  // Files are named after the recording.
  int runRecording() const {
    const std::string name = std::filesystem::path(options_.recording).stem().string();
    return watchRecording(
        {.file = options_.recording, .count = options_.count, .output = outputOptions(name)},
        common_);
  }

  AtlasOutputOptions outputOptions(const std::string& stream) const {
    AtlasOutputOptions output = options_.output;
    output.files = {.folder = options_.folder,
                    .stream = stream,
                    .writes_views = options_.writes_views,
                    .writes_png = options_.format == "png"};
    return output;
  }

  absl::Status openEyes(const v1::Display& display) {
    if (options_.eye_file.empty()) return absl::OkStatus();
    if (!display.stereo().tracked()) {
      return absl::InvalidArgumentError(
          "--eyes needs a display that tracks a head. Name one with --display: its stereo has "
          "\"tracked\": true");
    }
    auto eyes = EyeFeed::open(options_.eye_file);
    if (eyes.ok()) eyes_ = *std::move(eyes);
    return eyes.status();
  }

  EyeFeedCallbacks eyeCallbacks() {
    return {.send =
                [this](const v1::EyePoses& poses) {
                  eye_times_.note(poses.time_ns(), steadyNowNs());
                  watcher_->sendEyePoses(poses);
                },
            .on_failure = [this](const absl::Status& problem) { setFailure(problem); }};
  }

  WatcherCallbacks callbacks() {
    return {.on_layout = [this](const v1::AtlasLayout& layout) { sayLayout(layout); },
            .on_atlas = [this](const Atlas& atlas) { take(atlas); },
            .on_connection = waiting_->toldBefore(
                sayOrGiveUp(line_, common_, options_.has_no_retry,
                            [this](const absl::Status& reason) { setFailure(reason); }))};
  }

  // Once: eyes that move, and a focal plane that does, change no more than the views.
  void sayLayout(const v1::AtlasLayout& layout) {
    std::string grid = strCat("atlas ", layout.size().width(), "x", layout.size().height(), ", ",
                              layout.view_count(), " views of ", layout.tile_size().width(), "x",
                              layout.tile_size().height());
    if (grid == said_grid_) return;
    line_.say(strCat(grid, ", ", planeText(layout)));
    said_grid_ = std::move(grid);
  }

  void take(const Atlas& atlas) {
    if (failure().ok()) {
      const absl::Status written = outputs_->write(atlas, steadyNowNs());
      if (!written.ok()) setFailure(written);
    }
    sayHeld(atlas.header);
    if (const auto news = news_.note(atlas.header, planeText(*atlas.layout))) line_.say(*news);
    const std::optional<MotionLatency> motion = reportMotion(atlas);
    std::lock_guard lock(mutex_);
    if (motion) motion_ = motion;
    newest_ = atlas.header;
    rung_ = atlas.layout->video_rung();
    newest_times_ = atlas.end.times();
    latency_.note(newest_.frame_number(), newest_.capture_time_ns(), captureTimeNs());
  }

  // A display with a rate of its own waits for the publisher.
  void sayHeld(const v1::AtlasHeader& header) {
    if (header.timing() != v1::TIMING_HELD) return;
    line_.say(strCat("no frame after ", header.frame_number(), " yet: the picture is held"));
  }

  // The picture is here, and counts as shown: by the clock of the poses, which may be another's.
  std::optional<MotionLatency> reportMotion(const Atlas& atlas) {
    const v1::AtlasHeader& header = atlas.header;
    const int64_t shown_ns = steadyNowNs();
    const int64_t poses_time_ns = header.eye_poses_time_ns();
    const std::optional<int64_t> measured_ns = eye_times_.hereNs(poses_time_ns);
    if (!measured_ns) return std::nullopt;
    // Any whole number may stand in a file: the sum may wrap.
    const auto shown_there_ns = static_cast<int64_t>(static_cast<uint64_t>(poses_time_ns) +
                                                     uint64_t(shown_ns - *measured_ns));
    watcher_->reportPresented(header.sequence(), shown_there_ns);
    const std::optional<ClockOffset> server = watcher_->serverClock();
    return server ? motionLatency(atlas, *measured_ns, shown_ns, *server) : std::nullopt;
  }

  void setFailure(const absl::Status& status) {
    std::lock_guard lock(mutex_);
    failure_ = status;
  }

  absl::Status failure() const {
    std::lock_guard lock(mutex_);
    return failure_;
  }

  std::string status() {
    const WatcherCounts counts = watcher_->counts();
    if (counts.atlases.whole == 0) return strCat("waiting for stream ", options_.stream);
    const double rate = atlas_rate_.perSecond(counts.atlases.whole);
    const double bytes_rate = bytes_rate_.perSecond(counts.received_bytes);
    const std::optional<ClockOffset> server = watcher_->serverClock();
    std::lock_guard lock(mutex_);
    return strCat(
        "frame ", newest_.frame_number(), ": ", formatNumber(rate, 1), " atlases/s, ",
        formatBytes(bytes_rate), "/s, ", videoText(newest_, rung_), latencyText(), " (server ",
        formatNumber(1e-6 * double(newest_times_.total_ns()), 0), " ms); ", counts.atlases.whole,
        " whole, ", counts.atlases.gaps, " dropped, ", counts.atlases.discarded, " incomplete",
        motion_ ? "; " + motionText(*motion_) : "", server ? "; " + clockText(*server) : "",
        newest_.views_outside().empty()
            ? ""
            : "; past the edge of the source: " + outsideText(newest_.views_outside()));
  }

  std::string latencyText() const {
    const std::optional<double> standing_s = latency_.standing_s(captureTimeNs());
    if (standing_s) return strCat("no new frame for ", formatNumber(*standing_s, 0), " s");
    const std::optional<double> latency_s = latency_.seconds();
    return strCat("latency ",
                  latency_s ? formatNumber(1e3 * *latency_s, 0) + " ms" : "not known yet");
  }

  int end() {
    watcher_->stop();
    clock_.reset();
    eyes_.reset();
    while (!watcher_->waitEnded(kInterruptTick_ns)) {
    }
    if (watcher_->counts().atlases.whole > 0) line_.show(status());
    const absl::Status ended = *watcher_->ended();
    const absl::Status completed = outputs_->complete(steadyNowNs());
    if (const absl::Status failed = failure(); !failed.ok()) return reportError(failed, common_);
    if (!completed.ok() && (ended.ok() || absl::IsCancelled(ended))) {
      return reportError(completed, common_);
    }
    if (ended.ok()) return kExitDone;
    // Ctrl-C is the usual end of watching without a count.
    if (absl::IsCancelled(ended)) return options_.count == 0 ? kExitDone : kExitFailed;
    return reportError(ended, common_);
  }

  const WatchOptions& options_;
  const CommonOptions& common_;
  StatusLine line_;
  RateMeter atlas_rate_;
  RateMeter bytes_rate_;
  mutable std::mutex mutex_;
  v1::AtlasHeader newest_;
  uint32_t rung_ = 0;  // of its video
  v1::StageTimes newest_times_;
  FrameLatency latency_;
  std::optional<MotionLatency> motion_;
  absl::Status failure_;
  std::string said_grid_;  // the watcher's thread's own, as the next
  DefaultsNews news_;
  EyeTimes eye_times_;
  std::unique_ptr<AtlasOutputs> outputs_;  // the watcher's thread's own, until it has ended
  std::optional<StreamWait> waiting_;
  std::unique_ptr<Watcher> watcher_;  // its callbacks use what stands above
  std::unique_ptr<ClockFollower> clock_;
  std::unique_ptr<EyeFeed> eyes_;  // last: it gives to the watcher
};

}  // namespace

RunCommand addWatchCommand(const usage::Command& app) {
  const auto options = std::make_shared<WatchOptions>();
  app.footer(
      "Examples:\n"
      "  viewloom watch                                   print rate and latency of \"demo\"\n"
      "  viewloom watch --count 1 --out .                 save one quilt for the device\n"
      "  viewloom watch --preset portrait --views --out v --count 1\n"
      "  viewloom watch --columns 4 --rows 2 --size 1600x1200 --cone 20 --out quilts\n"
      "  viewloom watch --rgbd 960x540 --screen 2 --count 1 --out .   a 2D+Z picture\n"
      "  viewloom watch --output-rate 60 --between interpolate   60 atlases/s of any stream\n"
      "  viewloom watch --from portrait.vlr --out quilts  save the quilts of a recording\n"
      "  viewloom watch --from portrait.vlr --video clip.mp4   the same as a video\n"
      "  head-tracker | viewloom watch --display tracked.json --eyes - --out pairs");
  app.add("stream", options->stream, "Name of the stream").showDefault();
  const usage::Option from = app.add("--from", options->recording,
                                     "Read a recording of `viewloom record` instead of a stream")
                                 .valueName("FILE");
  app.add("--eyes", options->eye_file,
          "Eye positions for a tracked --display; - reads a pipe\n"
          "One line per time, positions in metres:\n"
          "{\"time_ns\": 8, \"left\": [x, y, z], \"right\": [x, y, z]}")
      .valueName("FILE")
      .excludes(from);
  app.add("--count", options->count, "Atlases to receive; 0 receives until Ctrl-C").showDefault();
  const usage::Option out =
      app.add("--out", options->folder, "Save each atlas in this folder").valueName("FOLDER");
  app.addFlag("--views", options->writes_views, "Save single views instead of atlases").needs(out);
  app.add("--format", options->format, "Format of the files").oneOf({"jpg", "png"}).showDefault();
  addVideoOptions(app, options->output);
  app.addFlag("--no-wait", options->fails_without_stream,
              "End if the server has no such stream, instead of waiting for it");
  app.addFlag("--no-retry", options->has_no_retry,
              "End if the server cannot be reached, instead of trying again");
  app.addFlag("-q,--quiet", options->is_quiet, "Print no status line");
  addDisplayOptions(app, options->display);
  addPanelOptions(app, options->display);
  addDepthDisplayOptions(app, options->display);
  addMaskOption(app, options->display.encoding);
  return [options](const CommonOptions& common) -> int { return WatchRun(*options, common).run(); };
}

}  // namespace viewloom::cli
