// SPDX-License-Identifier: Apache-2.0
#include "show/show_session.h"

#include <SDL.h>

#include <algorithm>
#include <utility>

#include "base/str_cat.h"
#include "eyes/eye_feed.h"
#include "lib/latency.h"
#include "lib/preferred_video.h"
#include "show/arrivals.h"
#include "show/display_link.h"
#include "show/mode_question.h"
#include "show/painter.h"
#include "show/show_statistics.h"
#include "show/shown_atlas.h"
#include "show/stage.h"

namespace viewloom::show {
namespace {

// How long the loop sleeps at most: interrupts and ended calls come without an event.
constexpr int64_t kTick_ns = 50'000'000;
constexpr SizePx kPlainWindow_px = {1280, 720};
constexpr uint32_t kNativeJpegQuality = 95;  // what blurs shows to the wrong eye

class ShowSession {
 public:
  ShowSession(std::shared_ptr<grpc::Channel> channel, const std::string& server,
              const SessionOptions& options, const SessionCallbacks& callbacks)
      : channel_(std::move(channel)),
        server_(server),
        options_(options),
        callbacks_(callbacks),
        settings_(options.settings),
        can_native_(options.calibration.has_value()) {}

  absl::Status run() {
    VIEWLOOM_RETURN_IF_ERROR(openEyes());
    VIEWLOOM_RETURN_IF_ERROR(openWindow());
    if (options_.is_mode_open) {
      askForMode();
    } else {
      connect();
    }
    if (eyes_) followEyes();
    absl::Status status;
    while (status.ok() && !is_done_ && !callbacks_.is_interrupted()) status = turn();
    question_.reset();
    eyes_.reset();
    link_.reset();
    return status;
  }

 private:
  absl::Status openEyes();
  void followEyes();
  absl::Status openWindow();
  void askForMode();
  void takeMode();
  void connect();
  WatcherCallbacks watcherCallbacks();
  absl::Status turn();
  void waitForEvents();
  absl::Status handleEvent(const SDL_Event& event);
  absl::Status act(ShowAction action);
  absl::Status checkEnded();
  absl::Status present(const DecodedAtlas& atlas);
  absl::Status redraw();
  absl::Status drawStatistics();
  v1::AtlasEncoding encoding() const;

  const std::shared_ptr<grpc::Channel> channel_;
  const std::string& server_;
  const SessionOptions& options_;
  const SessionCallbacks& callbacks_;
  ShowSettings settings_;
  bool can_native_;  // the server has not refused to interlace
  bool is_done_ = false;
  bool is_stale_ = true;  // the window has to be drawn again
  int64_t statistics_at_ns_ = 0;
  ShownRate rate_;
  FrameLatency latency_;

  // In the order in which they need one another.
  Stage stage_;
  std::unique_ptr<ShownAtlas> shown_;
  std::unique_ptr<TextOverlay> overlay_;
  Arrivals arrivals_;
  std::unique_ptr<ModeQuestion> question_;  // until it is answered; link_ comes after it
  std::unique_ptr<DisplayLink> link_;
  std::unique_ptr<EyeFeed> eyes_;
};

absl::Status ShowSession::openEyes() {
  if (options_.eye_file.empty()) return absl::OkStatus();
  auto eyes = EyeFeed::open(options_.eye_file);
  if (eyes.ok()) eyes_ = *std::move(eyes);
  return eyes.status();
}

void ShowSession::followEyes() {
  eyes_->start({.send = [this](const v1::EyePoses& poses) { link_->sendEyePoses(poses); },
                .on_failure = [this](const absl::Status& problem) { arrivals_.fail(problem); }});
}

absl::Status ShowSession::openWindow() {
  const std::optional<Calibration>& panel = options_.calibration;
  const bool is_for_panel =
      settings_.mode == ShowMode::kNative || settings_.mode == ShowMode::kWeave;
  absl::StatusOr<Stage> stage =
      openStage({.title = strCat("viewloom: ", options_.stream),
                 .monitor = options_.monitor,
                 .is_windowed = options_.is_windowed,
                 .windowed_px = panel ? panel->screen_px : kPlainWindow_px,
                 .panel_px = is_for_panel ? std::optional(panel->screen_px) : std::nullopt},
                callbacks_.say);
  if (!stage.ok()) return stage.status();
  stage_ = *std::move(stage);
  shown_ = std::make_unique<ShownAtlas>();
  return absl::OkStatus();
}

v1::AtlasEncoding ShowSession::encoding() const {
  v1::AtlasEncoding encoding = options_.encoding;
  if (settings_.mode == ShowMode::kNative) {
    encoding.set_jpeg_quality(std::max(encoding.jpeg_quality(), kNativeJpegQuality));
    // Video is for views. The server chooses what serves a panel's own pixels.
    if (encoding.color() == v1::BAND_ENCODING_H264) encoding.clear_color();
  }
  return encoding;
}

void ShowSession::askForMode() {
  question_ = std::make_unique<ModeQuestion>(channel_, callbacks_.on_connection, &wakeMainThread);
}

void ShowSession::takeMode() {
  const std::optional<SuitedMode> suited = question_->answer();
  if (!suited) return;
  settings_.mode = suited->mode;
  callbacks_.say(suited->reason);
  connect();
}

void ShowSession::connect() {
  question_.reset();
  v1::OpenDisplay open;
  open.set_stream(options_.stream);
  *open.mutable_display() = displayFor(settings_, options_.display, options_.calibration);
  *open.mutable_encoding() = encoding();
  preferVideo(server_, open);
  open.set_wait_for_stream(true);
  link_ = std::make_unique<DisplayLink>(channel_, std::move(open), watcherCallbacks());
}

WatcherCallbacks ShowSession::watcherCallbacks() {
  return {.on_layout = {},
          .on_atlas = [this](const Atlas& atlas) { arrivals_.take(atlas); },
          .on_connection =
              [this](const ConnectionEvent& event) {
                arrivals_.is_connected = event.kind == ConnectionEvent::Kind::kConnected;
                callbacks_.on_connection(event);
              }};
}

absl::Status ShowSession::turn() {
  waitForEvents();
  for (SDL_Event event; SDL_PollEvent(&event) != 0;) {
    VIEWLOOM_RETURN_IF_ERROR(handleEvent(event));
  }
  VIEWLOOM_RETURN_IF_ERROR(arrivals_.failed());
  if (question_) takeMode();
  VIEWLOOM_RETURN_IF_ERROR(checkEnded());
  if (const auto atlas = arrivals_.queue().take(wallTimeNs())) return present(*atlas);
  const bool is_due = settings_.has_statistics && wallTimeNs() - statistics_at_ns_ > 10 * kTick_ns;
  return is_stale_ || is_due ? redraw() : absl::OkStatus();
}

void ShowSession::waitForEvents() {
  int64_t wait_ns = is_stale_ ? 0 : kTick_ns;
  if (const std::optional<int64_t> due_ns = arrivals_.queue().nextDueNs()) {
    wait_ns = std::clamp<int64_t>(*due_ns - wallTimeNs(), 0, wait_ns);
  }
  const auto wait_ms = static_cast<int>((wait_ns + 999'999) / 1'000'000);
  if (wait_ms > 0) SDL_WaitEventTimeout(nullptr, wait_ms);
}

absl::Status ShowSession::handleEvent(const SDL_Event& event) {
  if (event.type == SDL_QUIT) is_done_ = true;
  if (event.type == SDL_WINDOWEVENT) is_stale_ = true;
  if (event.type != SDL_KEYDOWN) return absl::OkStatus();
  const std::optional<ShowAction> action = actionOfKey(event.key.keysym.sym);
  return action ? act(*action) : absl::OkStatus();
}

absl::Status ShowSession::act(ShowAction action) {
  const bool is_on_panel =
      options_.calibration && stage_.window->sizePx() == options_.calibration->screen_px;
  const ShowAbilities abilities{.can_weave = is_on_panel, .can_native = is_on_panel && can_native_};
  switch (applyAction(action, shown_->layout(), abilities, settings_)) {
    case ShowEffect::kNone:
      break;
    case ShowEffect::kQuit:
      is_done_ = true;
      break;
    case ShowEffect::kRedraw:
      is_stale_ = true;
      break;
    case ShowEffect::kFullScreen:
      stage_.window->toggleFullScreen();
      is_stale_ = true;
      break;
    case ShowEffect::kNewDisplay: {
      is_stale_ = true;
      if (link_ == nullptr) {  // the key has answered the question
        connect();
        break;
      }
      v1::ChangeDisplay change;
      *change.mutable_display() = displayFor(settings_, options_.display, options_.calibration);
      *change.mutable_encoding() = encoding();
      link_->change(std::move(change));
      break;
    }
  }
  return absl::OkStatus();
}

absl::Status ShowSession::checkEnded() {
  const std::optional<absl::Status> ended = link_ ? link_->ended() : std::nullopt;
  if (!ended) return absl::OkStatus();
  const bool is_refused =
      ended->code() == absl::StatusCode::kUnimplemented && settings_.mode == ShowMode::kNative;
  if (!is_refused) return ended->ok() ? absl::UnavailableError("the server ended") : *ended;
  callbacks_.say(strCat("this server does not interlace (", std::string(ended->message()),
                        "); quilts are woven here instead"));
  can_native_ = false;
  settings_.mode = ShowMode::kWeave;
  connect();
  return absl::OkStatus();
}

absl::Status ShowSession::present(const DecodedAtlas& atlas) {
  VIEWLOOM_RETURN_IF_ERROR(shown_->replace(atlas));
  VIEWLOOM_RETURN_IF_ERROR(redraw());
  const int64_t now_ns = wallTimeNs();
  link_->reportPresented(atlas.header.sequence(), now_ns);
  latency_.note(atlas.header.frame_number(), atlas.header.capture_time_ns(), now_ns);
  rate_.count();
  return absl::OkStatus();
}

absl::Status ShowSession::redraw() {
  const SizePx window_px = stage_.window->sizePx();
  stage_.painter->begin(window_px);
  shown_->draw(settings_, options_.calibration, window_px, *stage_.painter);
  if (settings_.has_statistics) VIEWLOOM_RETURN_IF_ERROR(drawStatistics());
  stage_.window->swap();
  is_stale_ = false;
  return absl::OkStatus();
}

absl::Status ShowSession::drawStatistics() {
  if (overlay_ == nullptr) {
    absl::StatusOr<std::unique_ptr<TextOverlay>> overlay = TextOverlay::make();
    if (!overlay.ok()) {
      callbacks_.say(std::string(overlay.status().message()));
      settings_.has_statistics = false;
      return absl::OkStatus();
    }
    overlay_ = *std::move(overlay);
  }
  statistics_at_ns_ = wallTimeNs();
  const ShowStatistics statistics{.rate_hz = rate_.perSecond(statistics_at_ns_),
                                  .dropped_count = (link_ ? link_->counts().atlases.gaps : 0) +
                                                   arrivals_.queue().droppedCount(),
                                  .latency_s = latency_.seconds(),
                                  .frame_number = shown_->header().frame_number(),
                                  .server_clock = link_ ? link_->serverClock() : std::nullopt,
                                  .is_connected = arrivals_.is_connected};
  return overlay_->draw(describe(statistics, settings_, shown_->layout()), *stage_.painter);
}

}  // namespace

absl::Status showStream(std::shared_ptr<grpc::Channel> channel, const std::string& server,
                        const SessionOptions& options, const SessionCallbacks& callbacks) {
  return ShowSession(std::move(channel), server, options, callbacks).run();
}

}  // namespace viewloom::show
