// SPDX-License-Identifier: Apache-2.0
#include "web/multipart_stream.h"

#include <chrono>
#include <utility>

#include "web/atlas_message.h"

namespace viewloom {
namespace {

using std::chrono_literals::operator""ms;

// The header of a part. It holds nothing that depends on the picture: it is sent before that.
constexpr const char* kOpening = "--viewloom\r\nContent-Type: image/jpeg\r\n\r\n";
constexpr const char* kNextOpening = "\r\n--viewloom\r\nContent-Type: image/jpeg\r\n\r\n";
constexpr const char* kClosingBoundary = "\r\n--viewloom--\r\n";
// A picture that no other follows is repeated after the first pause, for players that show a part
// when they have read on, and then after the second, so that proxies keep the connection open.
constexpr std::chrono::milliseconds kFirstPause = 200ms;
constexpr std::chrono::milliseconds kPause = 20'000ms;

}  // namespace

net::awaitable<void> MultipartStream::writeAtlases(ErrorCode& error) {
  co_await writeText(kOpening, error);
  Time repeat_time = Time::max();
  while (!error && !isOver()) {
    auto arrival = inbox().take();
    if (arrival || now() >= repeat_time) {
      if (arrival) shown_ = std::move(arrival->atlas);
      co_await writePart(kNextOpening, error);
      if (arrival && !error) context_.metrics.atlases_sent[Transport::kWeb].add();
      repeat_time = now() + (arrival ? kFirstPause : kPause);
      continue;
    }
    co_await waitUntil(repeat_time);
  }
}

// Completes the part that is open. An empty one would take the picture away.
net::awaitable<void> MultipartStream::writeEnd(ErrorCode& error) {
  if (!shown_) {
    co_await writeText(kClosingBoundary, error);
  } else {
    co_await writePart(kClosingBoundary, error);
  }
}

net::awaitable<void> MultipartStream::writePart(std::string end, ErrorCode& error) {
  const AtlasPtr atlas = shown_;
  std::vector<net::const_buffer> part;
  for (const SharedBytes& band : colorBands(*atlas)) part.push_back(net::buffer(*band));
  part.push_back(net::buffer(end));
  co_await write(std::move(part), error);
}

net::awaitable<void> MultipartStream::writeText(std::string text, ErrorCode& error) {
  std::vector<net::const_buffer> parts;
  parts.push_back(net::buffer(text));
  co_await write(std::move(parts), error);
}

}  // namespace viewloom
