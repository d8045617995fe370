// SPDX-License-Identifier: Apache-2.0
#include "lib/frame_messages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom::frame_messages_test {
namespace {

constexpr size_t kChunk_bytes = 300;

WireFrame makeFrame() {
  WireFrame frame;
  frame.header.set_number(7);
  for (const size_t size : {size_t{1000}, size_t{10}}) {
    std::vector<uint8_t> bytes(size);
    std::iota(bytes.begin(), bytes.end(), uint8_t{1});
    frame.planes.push_back(std::make_shared<const std::vector<uint8_t>>(std::move(bytes)));
  }
  return frame;
}

std::vector<FrameMessage> messagesOf(const WireFrame& frame) {
  std::vector<FrameMessage> messages;
  const auto take = [&](const FrameMessage& message) {
    messages.push_back(message);
    return true;
  };
  EXPECT_TRUE(takeFrameMessages(frame, take, [] { return kChunk_bytes; }));
  return messages;
}

// The messages as the library of Protocol Buffers writes them.
std::vector<std::string> serialisedByLibrary(const WireFrame& frame) {
  v1::PublishFramesRequest header;
  *header.mutable_header() = frame.header;
  std::vector<std::string> messages{header.SerializeAsString()};
  for (size_t plane = 0; plane < frame.planes.size(); ++plane) {
    const std::string bytes(frame.planes[plane]->begin(), frame.planes[plane]->end());
    for (size_t offset = 0; offset < bytes.size(); offset += kChunk_bytes) {
      v1::PublishFramesRequest request;
      request.mutable_chunk()->set_plane_index(static_cast<uint32_t>(plane));
      request.mutable_chunk()->set_offset_bytes(offset);
      request.mutable_chunk()->set_data(bytes.substr(offset, kChunk_bytes));
      messages.push_back(request.SerializeAsString());
    }
  }
  return messages;
}

std::vector<grpc::Slice> slicesOf(const FrameMessage& message) {
  std::vector<grpc::Slice> slices;
  EXPECT_TRUE(bytesOf(message).Dump(&slices).ok());
  return slices;
}

TEST(FrameMessages, areTheBytesThatProtocolBuffersWould) {
  const WireFrame frame = makeFrame();
  const std::vector<FrameMessage> messages = messagesOf(frame);
  const std::vector<std::string> expected = serialisedByLibrary(frame);
  ASSERT_EQ(messages.size(), expected.size());
  for (size_t i = 0; i < messages.size(); ++i) {
    std::string bytes;
    for (const grpc::Slice& slice : slicesOf(messages[i])) {
      bytes.append(slice.begin(), slice.end());
    }
    EXPECT_EQ(bytes, expected[i]) << i;
  }
}

TEST(FrameMessages, shareTheBytesOfPlanes) {
  const WireFrame frame = makeFrame();
  const std::vector<FrameMessage> messages = messagesOf(frame);
  const std::vector<grpc::Slice> second_chunk = slicesOf(messages.at(2));
  ASSERT_EQ(second_chunk.size(), 2U);
  EXPECT_EQ(second_chunk[1].begin(), frame.planes[0]->data() + kChunk_bytes);
  EXPECT_EQ(second_chunk[1].size(), kChunk_bytes);
}

TEST(FrameMessages, keepAPlaneUntilGrpcHasLetGoOfIt) {
  WireFrame frame = makeFrame();
  const std::weak_ptr<const std::vector<uint8_t>> plane = frame.planes[0];
  grpc::ByteBuffer bytes = bytesOf(messagesOf(frame).at(1));
  frame = {};
  EXPECT_FALSE(plane.expired());
  bytes.Clear();
  EXPECT_TRUE(plane.expired());
}

TEST(FrameMessages, endWhenNoFurtherOneIsWanted) {
  int count = 0;
  const auto take = [&](const FrameMessage&) { return ++count < 3; };
  EXPECT_FALSE(takeFrameMessages(makeFrame(), take, [] { return kChunk_bytes; }));
  EXPECT_EQ(count, 3);
}

}  // namespace
}  // namespace viewloom::frame_messages_test
