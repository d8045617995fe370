// SPDX-License-Identifier: Apache-2.0
#include "cli/stream_wait.h"
#include "cli/server_options.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/str_cat.h"
#include "cli/server_options.h"
#include "lib/catalog.h"

namespace viewloom::cli {
namespace {

constexpr std::chrono::seconds kFirst{1};     // a stream that is there comes sooner
constexpr std::chrono::seconds kInterval{2};  // between looks at the streams

}  // namespace

std::string waitingText(const std::string& stream, const std::vector<std::string>& names) {
  const std::string waiting = strCat("waiting for stream \"", stream, "\": ");
  if (names.empty()) {
    return strCat(waiting,
                  "the server has no stream yet; start one with `viewloom publish "
                  "--synthetic --stream ",
                  stream, "`");
  }
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  const std::string meant = didYouMean(stream, names);
  return strCat(waiting, "the server has ", list, meant.empty() ? "" : "; ", meant);
}

StreamWait::StreamWait(StatusLine& line, const CommonOptions& common, std::string stream)
    : line_(line),
      common_(common),
      stream_(std::move(stream)),
      thread_([this](std::stop_token stop) { run(stop); }) {}

OnConnection StreamWait::toldBefore(OnConnection listener) {
  return [this, listener = std::move(listener)](const ConnectionEvent& event) {
    {
      std::lock_guard lock(mutex_);
      is_here_ = false;  // the server may be there without the stream
    }
    changed_.notify_all();
    if (listener) listener(event);
  };
}

bool StreamWait::waitUntilMissing(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  return changed_.wait(lock, stop, [&] { return !is_here_; });
}

std::optional<std::vector<std::string>> StreamWait::listNames(const std::stop_token& stop) const {
  const auto streams = Catalog(channelTo(common_)).listStreams(stop);
  if (!streams.ok()) return std::nullopt;
  std::vector<std::string> names;
  for (const v1::StreamEntry& entry : streams->streams()) names.push_back(printable(entry.name()));
  return names;
}

void StreamWait::run(const std::stop_token& stop) {
  std::string said;
  std::chrono::seconds pause = kFirst;
  while (waitUntilMissing(stop)) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, stop, pause, [] { return false; });
    if (stop.stop_requested()) return;
    lock.unlock();
    pause = kInterval;
    const std::optional<std::vector<std::string>> names = listNames(stop);
    lock.lock();
    if (stop.stop_requested() || !names) continue;
    is_here_ = std::ranges::find(*names, stream_) != names->end();
    const std::string text = is_here_ ? "" : waitingText(stream_, *names);
    if (!text.empty() && text != said) line_.say(text);
    said = text;
  }
}

}  // namespace viewloom::cli
