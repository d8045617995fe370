// SPDX-License-Identifier: Apache-2.0
#include "cli/report_error.h"

#include <chrono>
#include <cstdio>
#include <memory>
#include <utility>

#include "base/printable.h"
#include "base/retry_delay.h"
#include "base/str_cat.h"
#include "cli/user_words.h"
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
  const std::string message = inUserWords(std::string(status.message()));
  switch (status.code()) {
    case absl::StatusCode::kUnavailable:
      if (!isFromTransport(status)) return strCat("the server at ", common.server, ": ", message);
      return strCat("no server at ", common.server, " (", connectionProblem(status),
                    "); start one with `viewloomd serve` or name another with --server HOST:PORT");
    case absl::StatusCode::kAlreadyExists:
      return strCat(happening(message),
                    retryDelayNs(status) ? "; waiting until it ends (another name: --stream NAME)"
                                         : "; choose another name with --stream, or end it");
    case absl::StatusCode::kAborted:
      return "another publisher with this --session took the stream over";
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

}  // namespace viewloom::cli
