// SPDX-License-Identifier: Apache-2.0
#include "cli/publish_run.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <utility>

#include "base/output_file.h"
#include "base/str_cat.h"
#include "cli/frame_feed.h"
#include "cli/interrupt.h"
#include "cli/outside_text.h"
#include "cli/report_error.h"
#include "cli/sent_frames.h"
#include "cli/server_options.h"
#include "cli/status_line.h"
#include "lib/channel.h"
#include "lib/publisher.h"

namespace viewloom::cli {
namespace {

constexpr int64_t kTick_ns = 20'000'000;          // how soon an interrupt or a due frame is seen
constexpr int64_t kFinish_ns = 120'000'000'000;   // for the reports of the last frames
constexpr int64_t kInterrupted_ns = 700'000'000;  // the same after Ctrl-C

// Coding and decoding of a picture take about as long as a gigabit link takes for its RGB
// (tests/performance.md, "Colour as video"). Smaller ones would be late there.
constexpr uint64_t kVideoGain_px = uint64_t{256} * 256;

class PublishRun {
 public:
  PublishRun(const PublishRunOptions& options, const CommonOptions& common,
             std::unique_ptr<FrameFeed> feed)
      : options_(options), common_(common), feed_(std::move(feed)), line_(options.is_quiet) {}

  int run() {
    int code = publish();
    say(feed_->takeLastNotes());
    publisher_.reset();  // no further frame is sent
    limit_.reset();      // only the disk is waited for, and a recording is not given up
    const bool was_kept = sent_.failure().ok();
    const absl::Status recorded = sent_.complete();
    if (!recorded.ok() && (code == kExitDone || !was_kept)) code = fail(recorded, kExitFailed);
    return code;
  }

 private:
  int publish() {
    if (!options_.record_file.empty()) {
      const absl::Status place = checkOutput(options_.record_file);
      if (!place.ok()) return fail(place, kExitUsage);
    }
    absl::StatusOr<std::optional<WireFrame>> frame = nextFrame(0);
    if (!frame.ok()) return fail(frame.status(), kExitUsage);
    catchInterrupts();
    if (!options_.record_file.empty()) {
      const absl::Status recording = sent_.record(options_.record_file);
      if (!recording.ok()) return fail(recording, kExitUsage);
    }
    limit_.emplace([this] { sent_.complete().IgnoreError(); });
    publisher_ = std::make_unique<Publisher>(channelTo(common_),
                                             PublisherOptions{.stream = options_.stream,
                                                              .session_id = options_.session_id,
                                                              .zstd_level = options_.zstd_level,
                                                              .predicts_depth = predictsDepth(),
                                                              .color_video = colorVideo()},
                                             callbacks());
    FramePace pace(clock_, options_.rate_hz.value_or(kDefaultRate_hz));
    double elapsed_s = 0;
    while (frame->has_value() || !feed_->hasEnded()) {
      if (!frame->has_value()) {
        tick();
      } else if (waitUntilSent()) {
        publisher_->offer(**std::move(frame));
        elapsed_s = waitUntilDue(pace);
      }
      if (isOver()) break;
      frame = nextFrame(elapsed_s);
      if (!frame.ok()) return fail(frame.status(), kExitUsage);
    }
    while (options_.is_holding && !isOver()) tick();
    return end();
  }

  bool predictsDepth() const {
    if (options_.depth_encoding != "auto") return options_.depth_encoding == "predicted";
    return !staysOnMachine(common_.server);
  }

  std::optional<ColorVideo> colorVideo() const {
    if (options_.color_encoding == "video") return ColorVideo{.qp = options_.color_qp};
    const bool is_plain = options_.color_encoding == "plain" || staysOnMachine(common_.server);
    if (is_plain) return std::nullopt;
    return ColorVideo{.qp = options_.color_qp, .area_min_px = kVideoGain_px};
  }

  absl::StatusOr<std::optional<WireFrame>> nextFrame(double elapsed_s) {
    absl::StatusOr<std::optional<WireFrame>> frame = feed_->next(elapsed_s);
    say(feed_->takeNotes());
    return frame;
  }

  void say(const std::vector<std::string>& notes) {
    for (const std::string& note : notes) line_.say(note);
  }

  PublisherCallbacks callbacks() {
    return {.on_accepted = {},
            .on_report = [this](const v1::FrameReport& report) { noteReport(report); },
            .on_wanted = [this](const v1::Wanted& wanted) { noteWanted(wanted); },
            .on_connection =
                [this, say = sayOrGiveUp(line_, common_, options_.has_no_retry,
                                         [this](const absl::Status& reason) {
                                           std::lock_guard lock(mutex_);
                                           given_up_ = reason;
                                         })](const ConnectionEvent& event) {
                  noteConnection(event);
                  say(event);
                },
            .on_sent = [this](const CompressedFrame& frame) { sent_.take(frame); }};
  }

  void noteReport(const v1::FrameReport& report) {
    if (!report.note().empty()) line_.say(strCat("frame ", report.number(), ": ", report.note()));
    if (report.outcome() != v1::FRAME_OUTCOME_REFUSED) return;
    std::lock_guard lock(mutex_);
    if (std::exchange(last_reason_, report.reason()) == report.reason()) return;
    line_.say(strCat("frame ", report.number(), " refused: ", inUserWords(report.reason())));
  }

  void noteConnection(const ConnectionEvent& event) {
    is_connected_ = event.kind == ConnectionEvent::Kind::kConnected;
    std::lock_guard lock(mutex_);
    missing_ = is_connected_ ? absl::OkStatus() : event.reason;
  }

  void noteWanted(const v1::Wanted& wanted) {
    displays_ = wanted.display_count();
    for (const std::string& warning : outside_.note(wanted)) line_.say(warning);
  }

  bool isOver() const {
    if (isInterrupted() || publisher_->ended() || !sent_.failure().ok()) return true;
    std::lock_guard lock(mutex_);
    return !given_up_.ok();
  }

  void tick(int64_t longest_ns = kTick_ns) {
    publisher_->waitEnded(std::min(kTick_ns, longest_ns));
    say(feed_->takeNotes());
    if (line_.isDue()) line_.show(status());
  }

  // False when there is no sense in going on.
  bool waitUntilSent() {
    while (!feed_->isLive() && publisher_->isWaiting() && !isOver()) tick();
    return !isOver();
  }

  // Waits for the next frame's time; returns it, in seconds since the start.
  double waitUntilDue(FramePace& pace) {
    const double due_s = pace.nextDue_s(feed_->nextDue_s());
    for (int64_t left_ns = pace.left_ns(due_s); left_ns > 0 && !isOver();
         left_ns = pace.left_ns(due_s)) {
      tick(left_ns);
    }
    return due_s;
  }

  std::string status() {
    const PublisherCounts counts = publisher_->counts();
    const double rate = sent_rate_.perSecond(counts.sent);
    const double bytes_rate = bytes_rate_.perSecond(counts.sent_bytes);
    return strCat(feed_->description(), " to ", options_.stream, ": ", formatNumber(rate, 1),
                  " frames/s, ", formatBytes(bytes_rate), "/s; ", counts.sent, " sent, ",
                  counts.replaced_here, " dropped here, ", counts.replaced_there,
                  " dropped by the server, ", counts.refused, " refused; ", depthStatus(),
                  displays_.load(), " displays");
  }

  std::string depthStatus() const {
    const double step = sent_.depthStep();
    return step > 0 ? strCat("depth step ", step, " 1/m; ") : "";
  }

  // Time counts while the server is there.
  void waitUntilReported() {
    publisher_->close();
    for (int64_t until_ns = clock_.nowNs() + kFinish_ns; !isOver() && clock_.nowNs() < until_ns;) {
      tick();
      if (!is_connected_) until_ns = clock_.nowNs() + kFinish_ns;
    }
  }

  int fail(const absl::Status& status, int code) {
    reportError(status, common_);
    return code;
  }

  int end() {
    if (std::lock_guard lock(mutex_); !given_up_.ok()) return reportError(given_up_, common_);
    const bool is_interrupted = isInterrupted();
    const absl::Status ended = publisher_->ended().value_or(absl::OkStatus());
    absl::Status status = ended;
    if (ended.ok() && (is_connected_ || !is_interrupted)) {
      if (!is_interrupted) waitUntilReported();
      if (std::lock_guard lock(mutex_); !given_up_.ok()) return reportError(given_up_, common_);
      status = publisher_->finish(kInterrupted_ns);
    }
    line_.show(this->status());
    const PublisherCounts counts = publisher_->counts();
    const bool is_stopped = isInterrupted() && ended.ok();
    if (is_stopped && counts.offered > 0 && counts.reported == 0) return failUnsent();
    if (!is_stopped && !status.ok()) return reportError(status, common_);
    return counts.refused > 0 ? kExitFailed : kExitDone;
  }

  // Ctrl-C came before the server had any frame.
  int failUnsent() const {
    std::lock_guard lock(mutex_);
    if (!missing_.ok()) return reportError(missing_, common_);
    return reportError(is_connected_
                           ? absl::DeadlineExceededError("it has reported no frame yet")
                           : absl::UnavailableError("it has not answered, and no frame was sent"),
                       common_);
  }

  const PublishRunOptions& options_;
  const CommonOptions& common_;
  std::unique_ptr<FrameFeed> feed_;
  StatusLine line_;
  RateMeter sent_rate_;
  RateMeter bytes_rate_;
  SteadyClock clock_;
  SentFrames sent_{line_, clock_};
  std::atomic<uint32_t> displays_{0};
  std::atomic<bool> is_connected_ = false;
  OutsideWarnings outside_;
  mutable std::mutex mutex_;
  absl::Status given_up_;                 // --no-retry: why
  absl::Status missing_;                  // why there is no connection; OK = not known, or there
  std::string last_reason_;               // of a refused frame
  std::optional<InterruptLimit> limit_;   // keeps the recording
  std::unique_ptr<Publisher> publisher_;  // last: its callbacks use the rest
};

}  // namespace

int runPublish(const PublishRunOptions& options, const CommonOptions& common,
               std::unique_ptr<FrameFeed> feed) {
  return PublishRun(options, common, std::move(feed)).run();
}

}  // namespace viewloom::cli
