// SPDX-License-Identifier: Apache-2.0
#include "cli/report_error.h"

#include <cstdio>
#include <utility>

#include "base/str_cat.h"

namespace viewloom::cli {

std::string explain(const absl::Status& status, const CommonOptions& common) {
  std::string message(status.message());
  switch (status.code()) {
    case absl::StatusCode::kUnavailable:
      return strCat("no server at ", common.server, " (", message,
                    "); start one with `viewloomd serve` or name another with --server HOST:PORT");
    case absl::StatusCode::kAlreadyExists:
      return strCat(message, "; choose another name with --stream, or end the other publisher");
    case absl::StatusCode::kAborted:
      return strCat("another publisher took the stream over (", message, ")");
    case absl::StatusCode::kDeadlineExceeded:
      return strCat("the server at ", common.server, " did not answer in time (", message, ")");
    default:
      return message;
  }
}

int reportError(const absl::Status& status, const CommonOptions& common) {
  const std::string text = explain(status, common);
  std::fprintf(stderr, "viewloom: %s\n", text.c_str());
  return status.code() == absl::StatusCode::kUnavailable ? kExitNoServer : kExitFailed;
}

OnConnection sayConnections(StatusLine& line, const CommonOptions& common) {
  return [&line, common, is_told = false](const ConnectionEvent& event) mutable {
    if (event.kind == ConnectionEvent::Kind::kConnected) {
      line.say(strCat("connected to ", common.server));
      is_told = false;
      return;
    }
    // What to do is said once; then only that it goes on.
    const std::string what = std::exchange(is_told, true) ? strCat("no answer from ", common.server)
                                                          : explain(event.reason, common);
    line.say(strCat(what, "; trying again in ",
                    formatNumber(static_cast<double>(event.delay_ns) * 1e-9, 1), " s"));
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
