// SPDX-License-Identifier: Apache-2.0
// Says which stream a command waits for, and which streams there are, until it comes.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/command.h"
#include "cli/status_line.h"
#include "lib/retry_loop.h"

namespace viewloom::cli {

// One line when the stream has not come within a second, and one each time the streams change.
// Thread-safety: all methods may be called from any thread.
class StreamWait {
 public:
  // The line must outlive it.
  StreamWait(StatusLine& line, const CommonOptions& common, std::string stream);

  // A connection came or went, so the stream is looked for again: what `listener` is told, this is
  // told first.
  OnConnection toldBefore(OnConnection listener);

 private:
  void run(const std::stop_token& stop);
  // False when it has been stopped.
  bool waitUntilMissing(const std::stop_token& stop);
  // The streams that are there; nothing when the server does not answer, which is told elsewhere.
  std::optional<std::vector<std::string>> listNames(const std::stop_token& stop) const;

  StatusLine& line_;
  const CommonOptions common_;
  const std::string stream_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  bool is_here_ = false;  // the stream was seen since the last event
  std::jthread thread_;   // last: uses the rest
};

// "waiting for stream "noe": no frame has come to this server yet; ...", by the names of the
// streams that are there.
std::string waitingText(const std::string& stream, const std::vector<std::string>& names);

}  // namespace viewloom::cli
