// SPDX-License-Identifier: Apache-2.0
// A publisher and the scripts of a server that takes its frames.
#pragma once

#include <gtest/gtest.h>

#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "e2e/client/scripted_server.h"
#include "lib/channel.h"
#include "lib/publisher.h"

namespace viewloom {

inline constexpr int64_t kLong_ns = 60'000'000'000;  // only a failing test waits so long
inline constexpr BackoffOptions kQuick{.first_ns = 1'000'000, .max_ns = 10'000'000, .factor = 2};

// A frame of two planes; the first is longer than a chunk.
inline WireFrame makeFrame(uint8_t seed) {
  WireFrame frame;
  v1::Layer& layer = *frame.header.add_sources()->add_layers();
  for (const size_t size : {size_t{2'500'000}, size_t{10}}) {
    std::vector<uint8_t> bytes(size);
    std::iota(bytes.begin(), bytes.end(), seed);
    layer.add_planes()->set_bytes_count(size);
    frame.planes.push_back(std::make_shared<const std::vector<uint8_t>>(std::move(bytes)));
  }
  return frame;
}

struct ReceivedFrame {
  v1::FrameHeader header;
  std::vector<std::string> planes;
};

// Reads settings; false when the call is broken.
inline bool accept(PublishStream& stream, v1::PublishSettings* settings = nullptr) {
  v1::PublishFramesRequest request;
  if (!stream.Read(&request) || !request.has_settings()) return false;
  if (settings != nullptr) *settings = request.settings();
  v1::PublishFramesResponse response;
  response.mutable_accepted();
  return stream.Write(response);
}

// The next message but heartbeats.
inline bool readMessage(PublishStream& stream, v1::PublishFramesRequest& request) {
  do {
    if (!stream.Read(&request)) return false;
  } while (request.has_heartbeat());
  return true;
}

// Reads one whole frame and checks the order of its chunks.
inline std::optional<ReceivedFrame> readFrame(PublishStream& stream) {
  v1::PublishFramesRequest request;
  if (!readMessage(stream, request)) return std::nullopt;
  EXPECT_TRUE(request.has_header());
  ReceivedFrame frame{request.header(), {}};
  for (const v1::Plane& plane : frame.header.sources(0).layers(0).planes()) {
    std::string& bytes = frame.planes.emplace_back();
    while (bytes.size() < plane.bytes_count()) {
      if (!readMessage(stream, request)) return std::nullopt;
      EXPECT_EQ(request.chunk().plane_index(), frame.planes.size() - 1);
      EXPECT_EQ(request.chunk().offset_bytes(), bytes.size());
      EXPECT_LE(request.chunk().data().size(), size_t{1} << 20);
      bytes += request.chunk().data();
    }
    EXPECT_EQ(bytes.size(), plane.bytes_count());
  }
  return frame;
}

inline bool report(PublishStream& stream, uint64_t number,
                   v1::FrameOutcome outcome = v1::FRAME_OUTCOME_TRACED) {
  v1::PublishFramesResponse response;
  response.mutable_report()->set_number(number);
  response.mutable_report()->set_outcome(outcome);
  return stream.Write(response);
}

inline grpc::Status takeAll(PublishStream& stream, std::vector<ReceivedFrame>& received) {
  while (std::optional<ReceivedFrame> frame = readFrame(stream)) {
    received.push_back(*frame);
    report(stream, frame->header.number());
  }
  return grpc::Status::OK;
}

inline grpc::Status noWatching(WatchStream&, int) {
  return {grpc::StatusCode::UNIMPLEMENTED, "not in this test"};
}

inline Publisher makePublisher(const std::string& address, PublisherOptions options = {},
                               PublisherCallbacks callbacks = {}) {
  options.stream = "s";
  options.backoff = kQuick;
  return Publisher(makeChannel(address), options, std::move(callbacks));
}

inline Publisher makePublisher(const ScriptedServer& server, PublisherOptions options = {},
                               PublisherCallbacks callbacks = {}) {
  return makePublisher(server.address(), std::move(options), std::move(callbacks));
}

}  // namespace viewloom
