// SPDX-License-Identifier: Apache-2.0
#include "cli/publish_command.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "base/str_cat.h"
#include "cli/file_options.h"
#include "cli/folder_frames.h"
#include "cli/interrupt.h"
#include "cli/plane_options.h"
#include "cli/report_error.h"
#include "cli/size_option.h"
#include "cli/status_line.h"
#include "cli/synthetic_frames.h"
#include "lib/channel.h"
#include "lib/publisher.h"

namespace viewloom::cli {
namespace {

constexpr int64_t kTick_ns = 20'000'000;            // how soon an interrupt or a due frame is seen
constexpr int64_t kFinish_ns = 120'000'000'000;     // for the reports of the last frames
constexpr int64_t kInterrupted_ns = 1'000'000'000;  // the same after Ctrl-C

struct PublishOptions {
  std::string stream = "demo";
  std::string session_id;
  bool is_synthetic = false;
  std::optional<uint32_t> layer_count;
  SyntheticFeedOptions synthetic;
  FileFeedOptions files;
  std::string watched_folder;
  double rate_hz = 15;
  bool is_holding = false;
  bool is_quiet = false;
  bool has_no_retry = false;
  int zstd_level = 0;
};

void addSourceOptions(CLI::App& app, PublishOptions& options) {
  app.add_flag("--synthetic", options.is_synthetic, "Publish the built-in moving scene")
      ->group("What");
  addSizeOption(app, "--size", options.synthetic.size_px, 8192, "Of the synthetic frames [960x540]")
      ->group("What");
  app.add_option("--layers", options.layer_count,
                 "Layers, 1..4: of the synthetic frames [2], at most of deep files [4]")
      ->check(CLI::Range(1, 4))
      ->group("What");
  app.add_option("--sources", options.synthetic.source_count,
                 "Cameras side by side that see the synthetic scene, 1..8 [1]")
      ->check(CLI::Range(1, 8))
      ->group("What");
  app.add_flag("--cube", options.synthetic.is_cube_map,
               "The synthetic scene as a cube map: six square faces as high as --size")
      ->excludes("--sources")
      ->group("What");
  app.add_option("--seconds", options.synthetic.duration_s,
                 "Length of the synthetic scene; 0 = without end")
      ->check(CLI::NonNegativeNumber)
      ->group("What");
}

void addStreamOptions(CLI::App& app, PublishOptions& options) {
  app.add_option("--stream", options.stream, "Name of the stream")->capture_default_str();
  app.add_option("--session", options.session_id,
                 "Secret with which this publisher may take its stream over again [random]");
  app.add_option("--fps,--rate", options.rate_hz, "Frames a second")
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  app.add_flag("--loop", options.files.is_looping, "Start again after the last file");
  app.add_flag("--hold", options.is_holding, "Keep the stream after the last frame, until Ctrl-C");
  app.add_option("--zstd", options.zstd_level,
                 "Compress planes, level 1..19; for slow links; 0 = do not")
      ->check(CLI::Range(0, 19))
      ->capture_default_str();
  app.add_flag("--no-retry", options.has_no_retry, "End when the server cannot be reached");
  app.add_flag("-q,--quiet", options.is_quiet, "No status line");
}

absl::StatusOr<std::unique_ptr<FrameFeed>> makeFeed(const PublishOptions& options) {
  const int kinds = int{options.is_synthetic} + int{!options.files.colors.empty()} +
                    int{!options.files.deeps.empty()} + int{!options.files.manifests.empty()} +
                    int{!options.watched_folder.empty()};
  if (kinds != 1) {
    return absl::InvalidArgumentError(
        "what to publish? Accepted is one of --synthetic, colour files, --deep, --manifest, "
        "--watch-folder");
  }
  if (options.is_synthetic) {
    SyntheticFeedOptions synthetic = options.synthetic;
    synthetic.layer_count = options.layer_count.value_or(synthetic.layer_count);
    return std::make_unique<SyntheticFrames>(synthetic);
  }
  FileFeedOptions files = options.files;
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

// One run of the command, from the first frame to the last report.
class PublishRun {
 public:
  PublishRun(const PublishOptions& options, const CommonOptions& common,
             std::unique_ptr<FrameFeed> feed)
      : options_(options), common_(common), feed_(std::move(feed)), line_(options.is_quiet) {}

  int run() {
    absl::StatusOr<std::optional<WireFrame>> frame = nextFrame(0);
    if (!frame.ok()) return fail(frame.status(), kExitUsage);
    publisher_ = std::make_unique<Publisher>(makeChannel(common_.server),
                                             PublisherOptions{.stream = options_.stream,
                                                              .session_id = options_.session_id,
                                                              .zstd_level = options_.zstd_level},
                                             callbacks());
    const auto start = std::chrono::steady_clock::now();
    double elapsed_s = 0;
    while (frame->has_value() || !feed_->hasEnded()) {
      if (!frame->has_value()) {
        tick();
      } else if (waitUntilSent()) {
        publisher_->offer(**std::move(frame));
        elapsed_s = waitUntilDue(start);
      }
      if (isOver()) break;
      frame = nextFrame(elapsed_s);
      if (!frame.ok()) return fail(frame.status(), kExitUsage);
    }
    while (options_.is_holding && !isOver()) tick();
    return end();
  }

 private:
  absl::StatusOr<std::optional<WireFrame>> nextFrame(double elapsed_s) {
    absl::StatusOr<std::optional<WireFrame>> frame = feed_->next(elapsed_s);
    for (const std::string& note : feed_->takeNotes()) line_.say(note);
    return frame;
  }

  PublisherCallbacks callbacks() {
    const OnConnection say = sayConnections(line_, common_);
    return {.on_accepted = {},
            .on_report = [this](const v1::FrameReport& report) { noteReport(report); },
            .on_wanted = [this](const v1::Wanted& wanted) { displays_ = wanted.display_count(); },
            .on_connection =
                [this, say](const ConnectionEvent& event) {
                  const bool is_lost = event.kind == ConnectionEvent::Kind::kRetrying;
                  if (is_lost && options_.has_no_retry) {
                    std::lock_guard lock(mutex_);
                    given_up_ = event.reason;
                  } else {
                    say(event);
                  }
                }};
  }

  void noteReport(const v1::FrameReport& report) {
    if (report.outcome() != v1::FRAME_OUTCOME_REFUSED) return;
    std::lock_guard lock(mutex_);
    if (std::exchange(last_reason_, report.reason()) == report.reason()) return;
    line_.say(strCat("frame ", report.number(), " refused: ", report.reason()));
  }

  bool isOver() const {
    if (isInterrupted() || publisher_->ended()) return true;
    std::lock_guard lock(mutex_);
    return !given_up_.ok();
  }

  void tick(int64_t longest_ns = kTick_ns) {
    publisher_->waitEnded(std::min(kTick_ns, longest_ns));
    if (line_.isDue()) line_.show(status());
  }

  // False when there is no sense in going on.
  bool waitUntilSent() {
    while (!feed_->isLive() && publisher_->isWaiting() && !isOver()) tick();
    return !isOver();
  }

  // Waits for the next frame's time; returns it, in seconds since the start.
  double waitUntilDue(std::chrono::steady_clock::time_point start) {
    const auto elapsed = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    // A late frame is left out rather than all that follow being late.
    due_index_ = std::max(due_index_ + 1, std::floor(elapsed() * options_.rate_hz));
    const double due_s = due_index_ / options_.rate_hz;
    for (double left_s = due_s - elapsed(); left_s > 0 && !isOver(); left_s = due_s - elapsed()) {
      tick(static_cast<int64_t>(left_s * 1e9));
    }
    return due_s;
  }

  std::string status() {
    const PublisherCounts counts = publisher_->counts();
    const double rate = sent_rate_.perSecond(counts.sent);
    const double bytes_rate = bytes_rate_.perSecond(counts.sent_bytes);
    return strCat(feed_->description(), " to ", options_.stream, ": ", formatNumber(rate, 1),
                  " frames/s, ", formatBytes(bytes_rate), "/s; ", counts.sent, " sent, overtaken ",
                  counts.replaced_here, " here, ", counts.replaced_there, " there, ",
                  counts.refused, " refused; ", displays_.load(), " displays");
  }

  int fail(const absl::Status& status, int code) {
    reportError(status, common_);
    return code;
  }

  int end() {
    if (std::lock_guard lock(mutex_); !given_up_.ok()) return reportError(given_up_, common_);
    const bool is_interrupted = isInterrupted();
    const absl::Status ended = publisher_->ended().value_or(absl::OkStatus());
    const bool was_served = publisher_->counts().sent > 0;
    absl::Status status = ended;
    if (ended.ok() && (was_served || !is_interrupted)) {
      status = publisher_->finish(is_interrupted ? kInterrupted_ns : kFinish_ns);
    }
    line_.show(this->status());
    if (is_interrupted && ended.ok()) return kExitDone;
    if (!status.ok()) return reportError(status, common_);
    return publisher_->counts().refused > 0 ? kExitFailed : kExitDone;
  }

  const PublishOptions& options_;
  const CommonOptions& common_;
  std::unique_ptr<FrameFeed> feed_;
  StatusLine line_;
  RateMeter sent_rate_;
  RateMeter bytes_rate_;
  double due_index_ = 0;
  std::atomic<uint32_t> displays_{0};
  mutable std::mutex mutex_;
  absl::Status given_up_;                 // --no-retry: why
  std::string last_reason_;               // of a refused frame
  std::unique_ptr<Publisher> publisher_;  // last: its callbacks use the rest
};

}  // namespace

RunCommand addPublishCommand(CLI::App& app) {
  const auto options = std::make_shared<PublishOptions>();
  app.footer(
      "Examples:\n"
      "  viewloom publish --synthetic --size 1280x720 --layers 3\n"
      "  viewloom publish frame.exr --focal-px 1200 --hold\n"
      "  viewloom publish --deep comp.*.exr --layers 3 --fov 35 --loop\n"
      "  viewloom publish stereo.*.exr --view right --depth-far-zero --fps 24 --loop\n"
      "  viewloom publish photo.png --depth photo_mm.png --input sensor --fov 50 --hold\n"
      "  viewloom publish --watch-folder renders/ --fps 24");
  addSourceOptions(app, *options);
  addFileOptions(app, options->files);
  app.add_option("--watch-folder", options->watched_folder,
                 "Publish every complete file that is in this folder or comes into it; colour and "
                 "depth in two files pair up by name, as x.png and x_depth.png")
      ->group("What");
  addStreamOptions(app, *options);
  addPlaneOptions(app, options->files.loader.input);
  return [options](const CommonOptions& common) -> int {
    absl::StatusOr<std::unique_ptr<FrameFeed>> feed = makeFeed(*options);
    if (!feed.ok()) {
      reportError(feed.status(), common);
      return kExitUsage;
    }
    return PublishRun(*options, common, *std::move(feed)).run();
  };
}

}  // namespace viewloom::cli
