// SPDX-License-Identifier: Apache-2.0
// Errors as a person wants to read them: what happened, in the words of the command line, and what
// to do about it.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "base/status.h"
#include "cli/command.h"
#include "cli/status_line.h"
#include "lib/retry_loop.h"

namespace viewloom::cli {

// "cannot reach 127.0.0.1:50051: ...; start a server with `viewloomd serve`, ..."
std::string explain(const absl::Status& status, const CommonOptions& common);

// Says it on stderr; returns the exit code that belongs to it.
int reportError(const absl::Status& status, const CommonOptions& common);

// Says when the connection comes, goes and is tried again.
OnConnection sayConnections(StatusLine& line, const CommonOptions& common);

// The same; but give_up gets the reason why it went where it is not to be tried again.
OnConnection sayOrGiveUp(StatusLine& line, const CommonOptions& common, bool has_no_retry,
                         std::function<void(const absl::Status&)> give_up);

// The message with the field that it begins with named as the user knows it: "--cone: got 400; ..."
// for "display.quilt.view_cone_rad: got 400; ...", "layer 2, depth: ..." for
// "sources[0].layers[1].depth: ...". Fields of messages that the user gave whole (CommonOptions)
// keep their names there: "display.quilt.view_cone_rad: got 7; ...". Other messages stay.
std::string inUserWords(const std::string& message, std::span<const std::string> whole = {});

}  // namespace viewloom::cli
