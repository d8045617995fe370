// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"

#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "base/clock.h"
#include "base/str_cat.h"
#include "cli/atlas_outputs.h"
#include "cli/display_options.h"
#include "cli/interrupt.h"
#include "cli/report_error.h"
#include "cli/server_options.h"
#include "cli/status_line.h"
#include "cli/stream_wait.h"
#include "lib/preferred_video.h"
#include "lib/watcher.h"
#include "recording/atlas_recording.h"
#include "recording/file_encoder.h"
#include "recording/video_recorder.h"

namespace viewloom::cli {
namespace {

constexpr int64_t kRestOfAtlas_ns = 5'000'000'000;     // for the rest of an atlas that has begun
constexpr int64_t kInterruptedAtlas_ns = 800'000'000;  // the same after Ctrl-C

struct RecordOptions {
  std::string stream = "demo";
  std::string file;
  std::string video_encoder = "auto";
  DisplayOptions display;
  uint32_t count = 0;
  double duration_s = 0;
  bool fails_without_stream = false;
  bool has_no_retry = false;
  bool is_quiet = false;
};

class RecordRun {
 public:
  RecordRun(const RecordOptions& options, const CommonOptions& common)
      : options_(options), common_(common), line_(options.is_quiet) {}

  int run() {
    const absl::StatusOr<v1::Display> display = makeDisplay(options_.display);
    if (!display.ok()) return usage(display.status());
    const absl::StatusOr<v1::AtlasEncoding> encoding = makeEncoding(options_.display.encoding);
    if (!encoding.ok()) return usage(encoding.status());
    catchInterrupts();
    auto target = openTarget();
    if (!target.ok()) return usage(target.status());
    target_ = *std::move(target);
    v1::OpenDisplay open;
    open.set_stream(options_.stream);
    *open.mutable_display() = *display;
    *open.mutable_encoding() = *encoding;
    preferVideo(common_.server, open);
    open.set_count(options_.count);
    open.set_wait_for_stream(!options_.fails_without_stream);
    watcher_ = std::make_unique<Watcher>(channelTo(common_), open, callbacks());
    while (!watcher_->waitEnded(kInterruptTick_ns) && !isInterrupted() && failure().ok() &&
           !isTimeOver()) {
      if (line_.isDue()) line_.show(status());
    }
    finishAtlas();
    return end();
  }

 private:
  int usage(const absl::Status& status) const {
    reportError(status, common_);
    return kExitUsage;
  }

  absl::StatusOr<std::unique_ptr<AtlasTarget>> openTarget() const {
    if (isVideoName(options_.file)) {
      auto encoders = chooseFileEncoder(options_.video_encoder);
      if (!encoders.ok()) return withFieldPrefix(encoders.status(), "--video-encoder");
      return VideoRecorder::create(options_.file, options_.stream, clock_, *std::move(encoders));
    }
    return AtlasRecorder::create(options_.file, clock_);
  }

  WatcherCallbacks callbacks() {
    return {.on_layout = {},
            .on_atlas = {},
            .on_connection = waiting_.toldBefore(
                sayOrGiveUp(line_, common_, options_.has_no_retry,
                            [this](const absl::Status& reason) { setFailure(reason); })),
            .on_message = [this](const v1::StreamAtlasesResponse& message) { take(message); }};
  }

  void take(const v1::StreamAtlasesResponse& message) {
    std::lock_guard lock(mutex_);
    if (!failure_.ok()) return;
    if (start_ns_ == 0) start_ns_ = clock_.nowNs();
    failure_ = target_->add(message);
  }

  void setFailure(const absl::Status& status) {
    std::lock_guard lock(mutex_);
    failure_ = status;
  }

  absl::Status failure() const {
    std::lock_guard lock(mutex_);
    return failure_;
  }

  // Counted from the first message: until then there is nothing to record.
  bool isTimeOver() const {
    std::lock_guard lock(mutex_);
    const double since_s = static_cast<double>(clock_.nowNs() - start_ns_) * 1e-9;
    return options_.duration_s > 0 && start_ns_ != 0 && since_s >= options_.duration_s;
  }

  bool isWithinAtlas() const {
    std::lock_guard lock(mutex_);
    return failure_.ok() && target_->isWithinAtlas();
  }

  // An atlas that has begun is worth waiting for; then the call is broken off.
  void finishAtlas() {
    const int64_t begun_ns = clock_.nowNs();
    const auto isOver = [&] {
      return clock_.nowNs() - begun_ns >=
             (isInterrupted() ? kInterruptedAtlas_ns : kRestOfAtlas_ns);
    };
    while (isWithinAtlas() && !isOver() && !watcher_->waitEnded(kInterruptTick_ns)) {
    }
    watcher_->stop();
    while (!watcher_->waitEnded(kInterruptTick_ns)) {
    }
  }

  std::string status() {
    const WatcherCounts counts = watcher_->counts();
    if (counts.atlases.whole == 0) return strCat("waiting for stream ", options_.stream);
    return strCat(counts.atlases.whole, " atlases, ",
                  formatBytes(static_cast<double>(counts.received_bytes)), "; ",
                  counts.atlases.gaps, " dropped, ", counts.atlases.discarded, " incomplete");
  }

  int end() {
    const absl::Status ended = *watcher_->ended();
    const bool is_stopped = ended.code() == absl::StatusCode::kCancelled;
    absl::Status failed = failure();
    if (failed.ok() && !ended.ok() && !is_stopped) failed = ended;
    // Atlases that came before an error are kept.
    const absl::Status completed = target_->complete();
    if (completed.ok()) line_.say(target_->summary());
    if (!failed.ok()) return reportError(failed, common_);
    if (!completed.ok()) return reportError(completed, common_);
    return is_stopped && options_.count > 0 && options_.duration_s == 0 ? kExitFailed : kExitDone;
  }

  const RecordOptions& options_;
  const CommonOptions& common_;
  SteadyClock clock_;
  StatusLine line_;
  mutable std::mutex mutex_;
  std::unique_ptr<AtlasTarget> target_;
  int64_t start_ns_ = 0;  // when the first message came; 0 = none has
  absl::Status failure_;
  StreamWait waiting_{line_, common_, options_.stream};
  std::unique_ptr<Watcher> watcher_;  // last: its callbacks use the rest
};

}  // namespace

RunCommand addRecordCommand(const usage::Command& app) {
  const auto options = std::make_shared<RecordOptions>();
  app.footer(
      "Examples:\n"
      "  viewloom record --out demo.vlr                   until Ctrl-C\n"
      "  viewloom record demo --seconds 10 --preset portrait --out portrait.vlr\n"
      "  viewloom watch --from portrait.vlr --out quilts  save its views as pictures\n"
      "  viewloom record --seconds 10 --out clip.mp4      a video for players of quilts\n"
      "This records views. To record the frames of a publisher, use `viewloom publish --record`.");
  app.add("stream", options->stream, "Name of the stream").showDefault();
  app.add("--out", options->file,
          "Recording to write; the file appears when it is complete\n"
          "A name that ends in .mp4 gives a video for players of quilts")
      .valueName("FILE")
      .required();
  addVideoEncoderOption(app, options->video_encoder);
  app.add("--count", options->count, "Atlases to record; 0 records until Ctrl-C").showDefault();
  app.add("--seconds", options->duration_s, "Length of the recording; 0 records until Ctrl-C")
      .valueName("SECONDS")
      .notNegative()
      .showDefault();
  app.addFlag("--no-wait", options->fails_without_stream,
              "End if the server has no such stream, instead of waiting for it");
  app.addFlag("--no-retry", options->has_no_retry,
              "End if the server cannot be reached, instead of trying again");
  app.addFlag("-q,--quiet", options->is_quiet, "Print no status line");
  addDisplayOptions(app, options->display);
  addDepthDisplayOptions(app, options->display);
  return
      [options](const CommonOptions& common) -> int { return RecordRun(*options, common).run(); };
}

}  // namespace viewloom::cli
