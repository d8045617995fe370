// SPDX-License-Identifier: Apache-2.0
#include "cli/report_error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string_view>
#include <utility>

#include "base/printable.h"
#include "base/retry_delay.h"
#include "base/str_cat.h"
#include "lib/broken_call.h"
#include "lib/channel.h"

namespace viewloom::cli {
namespace {

// The same problem is told again after so long.
constexpr std::chrono::seconds kTellAgain{10};

// The event that a refusal reports, without its field and without its advice to programs.
std::string happening(const std::string& message) {
  const std::string text = message.substr(0, message.find("; "));
  const size_t colon = text.find(": ");
  const bool has_field = colon != std::string::npos && text.find(' ') > colon;
  return has_field ? text.substr(colon + 2) : text;
}

// Says when a connection comes, goes and is tried again. A call that goes for one reason over and
// over is told seldom. Thread-safety: none.
class ConnectionTeller {
 public:
  ConnectionTeller(StatusLine& line, CommonOptions common)
      : line_(&line), common_(std::move(common)) {}

  void tell(const ConnectionEvent& event) {
    if (event.kind == ConnectionEvent::Kind::kConnected) {
      tellConnected();
    } else {
      tellRetrying(event);
    }
  }

 private:
  void tellConnected() {
    if (std::exchange(is_connected_, true)) return;
    line_->say(strCat("connected to ", common_.server));
  }

  void tellRetrying(const ConnectionEvent& event) {
    const auto now = std::chrono::steady_clock::now();
    const bool was_connected = std::exchange(is_connected_, false);
    const bool is_same = event.reason.code() == reason_.code() &&
                         isFromTransport(event.reason) == isFromTransport(reason_);
    if (is_same && now - told_at_ < kTellAgain) return;
    // The remedy is said once, later only the fact that the server is still away.
    const bool is_gone = is_same && !was_connected;
    const std::string what = is_gone && absl::IsUnavailable(event.reason)
                                 ? strCat("still no answer from ", common_.server)
                                 : explain(event.reason, common_);
    const bool waits = retryDelayNs(event.reason).has_value();
    line_->say(waits ? what
                     : strCat(what, "; trying again in ",
                              formatNumber(static_cast<double>(event.delay_ns) * 1e-9, 1), " s"));
    reason_ = event.reason;
    told_at_ = now;
  }

  StatusLine* line_;
  CommonOptions common_;
  bool is_connected_ = false;
  absl::Status reason_;  // told last
  std::chrono::steady_clock::time_point told_at_;
};

}  // namespace

std::string explain(const absl::Status& status, const CommonOptions& common) {
  if (const std::string broken = explainBrokenCall(status); !broken.empty()) return broken;
  const std::string message = inUserWords(std::string(status.message()), common.messages);
  switch (status.code()) {
    case absl::StatusCode::kUnavailable:
      if (!isFromTransport(status)) return strCat("the server at ", common.server, ": ", message);
      return strCat("no server at ", common.server, " (", connectionProblem(status),
                    "); start one with `viewloomd serve`, or name another with --server HOST:PORT");
    case absl::StatusCode::kAlreadyExists:
      return strCat(happening(message),
                    retryDelayNs(status)
                        ? "; waiting until it ends. To use another name, give --stream NAME"
                        : "; end that stream, or choose another name with --stream");
    case absl::StatusCode::kAborted:
      return "another publisher with the same --session has taken over the stream";
    case absl::StatusCode::kDeadlineExceeded:
      return strCat("the server at ", common.server, " did not answer in time (", message, ")");
    default:
      return message;
  }
}

int reportError(const absl::Status& status, const CommonOptions& common) {
  const std::string text = explain(status, common);
  std::fprintf(stderr, "viewloom: %s\n", printable(text, true).c_str());
  return status.code() == absl::StatusCode::kUnavailable ? kExitNoServer : kExitFailed;
}

OnConnection sayConnections(StatusLine& line, const CommonOptions& common) {
  // Shared, as whoever calls may keep copies of the callback.
  return [teller = std::make_shared<ConnectionTeller>(line, common)](const ConnectionEvent& event) {
    teller->tell(event);
  };
}

OnConnection sayOrGiveUp(StatusLine& line, const CommonOptions& common, bool has_no_retry,
                         std::function<void(const absl::Status&)> give_up) {
  OnConnection say = sayConnections(line, common);
  if (!has_no_retry) return say;
  return [say = std::move(say), give_up = std::move(give_up)](const ConnectionEvent& event) {
    if (event.kind == ConnectionEvent::Kind::kRetrying) {
      give_up(event.reason);
    } else {
      say(event);
    }
  };
}

namespace {

// Fields by the end of their path.
constexpr std::array<std::pair<std::string_view, std::string_view>, 32> kOptions{{
    {"preset", "--preset"},
    {"columns", "--columns"},
    {"rows", "--rows"},
    {"quilt.size", "--size"},
    {"quilt.size.width", "--size"},
    {"quilt.size.height", "--size"},
    {"view_cone_rad", "--cone"},
    {"focal_distance_m", "--focal-distance"},
    {"fov_y_rad", "--fov"},
    {"focus_following_s", "--focus-follow"},
    {"filter.sample_count", "--samples"},
    {"reflection.bounces", "--reflections"},
    {"jpeg_quality", "--quality"},
    {"calibration_json", "--calibration"},
    {"rgbd.view_size", "--rgbd"},
    {"rgbd.view_size.width", "--rgbd"},
    {"rgbd.view_size.height", "--rgbd"},
    {"rgbd.depth_placement", "--depth-side"},
    {"rgbd.depth_bits", "--depth-bits"},
    {"rgbd.near_m", "--depth-near"},
    {"rgbd.far_m", "--depth-far"},
    {"rgbd.screen_m", "--screen"},
    {"near_m", "--near"},
    {"far_m", "--far"},
    {"output_rate_hz", "--output-rate"},
    {"temporal.bridge_s", "--bridge"},
    {"lens.aperture_radius_m", "--aperture"},
    {"lens.automatic_aperture", "--auto-aperture"},
    {"lens.focus_distance_m", "--lens-focus"},
    {"lens.blades", "--blades"},
    {"lens.samples", "--lens-samples"},
    {"lens.gathered_samples", "--lens-gathered"},
}};

bool isPath(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char letter) {
    return std::isalnum(letter) != 0 || letter == '_' || letter == '.' || letter == '[' ||
           letter == ']';
  });
}

// Where a part of the path begins; npos = it has no such part.
size_t placeOfPart(std::string_view path, std::string_view name) {
  for (size_t begin = 0; begin < path.size();) {
    const size_t end = std::min(path.find('.', begin), path.size());
    if (path.substr(begin, end - begin) == name) return begin;
    begin = end + 1;
  }
  return std::string_view::npos;
}

// Takes "NAME[N]." or "NAME[N]" off the front; 0 = it does not begin so. Counts from 1.
uint64_t takeIndex(std::string_view& path, std::string_view name) {
  std::string_view rest = path;
  if (!rest.starts_with(name)) return 0;
  rest.remove_prefix(name.size());
  uint64_t index = 0;
  if (!rest.starts_with('[')) return 0;
  const auto [stop, error] = std::from_chars(rest.data() + 1, rest.data() + rest.size(), index);
  if (error != std::errc() || stop == rest.data() + rest.size() || *stop != ']') return 0;
  rest.remove_prefix(size_t(stop - rest.data()) + 1);
  if (rest.starts_with('.')) rest.remove_prefix(1);
  path = rest;
  return index + 1;
}

std::string placeInFrame(std::string_view path) {
  std::string place;
  const auto add = [&](const std::string& part) { place += (place.empty() ? "" : ", ") + part; };
  const uint64_t source = takeIndex(path, "sources");
  if (source == 0) return "";
  // Most frames have one source, and users who gave none number none.
  if (source > 1) add(strCat("source ", source));
  const uint64_t layer = takeIndex(path, "layers");
  if (layer != 0) add(strCat("layer ", layer));
  const uint64_t plane = takeIndex(path, "planes");
  if (plane != 0) add(strCat("plane ", plane));
  std::string rest(path);
  std::ranges::replace(rest, '_', ' ');
  std::ranges::replace(rest, '.', ' ');
  if (!rest.empty()) add(rest);
  return place.empty() ? "the frame" : place;
}

}  // namespace

std::string inUserWords(const std::string& message, std::span<const std::string> whole) {
  const size_t colon = message.find(": ");
  if (colon == std::string::npos) return message;
  const std::string_view path = std::string_view(message).substr(0, colon);
  if (!isPath(path)) return message;
  // The file's name follows.
  if (path == "deep") return message.substr(colon + 2);
  for (const std::string& name : whole) {
    const size_t begin = placeOfPart(path, name);
    if (begin != std::string_view::npos) return message.substr(begin);
  }
  for (const auto& [end, option] : kOptions) {
    const size_t before = path.size() - std::min(path.size(), end.size());
    if (path.ends_with(end) && (before == 0 || path[before - 1] == '.')) {
      return strCat(option, message.substr(colon));
    }
  }
  const std::string place = placeInFrame(path);
  return place.empty() ? message : strCat(place, message.substr(colon));
}

}  // namespace viewloom::cli
