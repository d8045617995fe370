// SPDX-License-Identifier: Apache-2.0
// One frame that a publisher sends to a server, as it went and as it arrived.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <utility>

#include "e2e/test_server.h"
#include "lib/channel.h"
#include "lib/publisher.h"

namespace viewloom::test {

struct Arrived {
  CompressedFrame sent;
  v1::FrameReport report;
  FramePtr frame;
};

// `options`: all but the stream and the session.
inline Arrived sendFrame(WireFrame frame, PublisherOptions options) {
  constexpr std::chrono::minutes kPatience{1};  // only a failing test waits so long
  TestServer server;
  std::promise<v1::FrameReport> report;
  Arrived arrived;
  PublisherCallbacks callbacks;
  callbacks.on_sent = [&](const CompressedFrame& sent) { arrived.sent = sent; };
  callbacks.on_report = [&](const v1::FrameReport& its) { report.set_value(its); };
  options.stream = "s";
  Publisher publisher(makeChannel(server.address()), options, callbacks);
  publisher.offer(std::move(frame));
  auto future = report.get_future();
  EXPECT_EQ(future.wait_for(kPatience), std::future_status::ready);
  arrived.report = future.get();
  arrived.frame = server.sink().resident("s");
  EXPECT_EQ(publisher.finish(std::chrono::nanoseconds(kPatience).count()), absl::OkStatus());
  return arrived;
}

}  // namespace viewloom::test
