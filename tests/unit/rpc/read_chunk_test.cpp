// SPDX-License-Identifier: Apache-2.0
#include "rpc/read_chunk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom::read_chunk_test {
namespace {

constexpr char kBytes[] = "0123456789";  // of the one plane of the frame

FrameFormat onePlane() {
  LayerFormat layer;
  layer.color.wire_bytes = 10;
  layer.depth.wire_bytes = 1;
  return {.number = 7, .sources = {{.layers = {layer}}}};
}

std::string chunk(uint32_t plane_index, uint64_t offset_bytes, const std::string& data) {
  v1::PublishFramesRequest request;
  request.mutable_chunk()->set_plane_index(plane_index);
  request.mutable_chunk()->set_offset_bytes(offset_bytes);
  request.mutable_chunk()->set_data(data);
  return request.SerializeAsString();
}

// In slices of so many bytes, as they may come off the wire.
grpc::ByteBuffer inSlices(const std::string& bytes, size_t slice_bytes) {
  std::vector<grpc::Slice> slices;
  for (size_t at = 0; at < bytes.size(); at += slice_bytes) {
    slices.emplace_back(bytes.data() + at, std::min(slice_bytes, bytes.size() - at));
  }
  return {slices.data(), slices.size()};
}

class ReadChunk : public testing::Test {
 protected:
  std::optional<absl::StatusOr<uint64_t>> read(const std::string& bytes, size_t slice_bytes = 7) {
    grpc::ByteBuffer buffer = inSlices(bytes, slice_bytes);
    return readChunk(buffer, assembly_);
  }
  // A message that is left to the parser changes nothing: the first chunk is still due.
  void expectLeft(const std::string& bytes) {
    EXPECT_FALSE(read(bytes).has_value());
    EXPECT_TRUE(assembly_.addChunk(0, 0, "012").ok());
  }

  BytePool pool_{4};
  FrameAssembly assembly_{onePlane(), pool_};
};

TEST_F(ReadChunk, takesTheBytesHoweverTheyAreCut) {
  for (const size_t slice_bytes : {1U, 3U, 100U}) {
    BytePool pool(0);  // so that no buffer holds the bytes of another turn
    FrameAssembly assembly(onePlane(), pool);
    for (const auto& [offset, data] : {std::pair(0, "012345"), std::pair(6, "6789")}) {
      grpc::ByteBuffer buffer = inSlices(chunk(0, offset, data), slice_bytes);
      const auto taken = readChunk(buffer, assembly);
      ASSERT_TRUE(taken.has_value() && taken->ok()) << slice_bytes;
      EXPECT_EQ(**taken, std::string(data).size());
    }
    ASSERT_TRUE(assembly.addChunk(1, 0, "d").ok());
    const CollectedFrame frame = assembly.take();
    EXPECT_EQ(std::string(frame.planes[0]->begin(), frame.planes[0]->end()), kBytes);
  }
}

TEST_F(ReadChunk, refusesWhatDoesNotFollowOn) {
  for (const auto& [bytes, field] : {std::pair(chunk(1, 0, "0"), "chunk.plane_index"),
                                     std::pair(chunk(0, 1, "0"), "chunk.offset_bytes"),
                                     std::pair(chunk(0, 0, "0123456789a"), "chunk.data"),
                                     std::pair(chunk(0, 1ULL << 63, "0"), "chunk.offset_bytes")}) {
    FrameAssembly assembly(onePlane(), pool_);
    grpc::ByteBuffer buffer = inSlices(bytes, 7);
    const auto taken = readChunk(buffer, assembly);
    ASSERT_TRUE(taken.has_value());
    EXPECT_EQ(fieldOf(taken->status()), field);
  }
}

TEST_F(ReadChunk, leavesOtherMessagesToTheParser) {
  v1::PublishFramesRequest request;
  request.mutable_heartbeat();
  expectLeft(request.SerializeAsString());
}

TEST_F(ReadChunk, leavesTwoChunksInOneMessageToTheParser) {
  expectLeft(chunk(0, 0, "012") + chunk(0, 3, "345"));
}

TEST_F(ReadChunk, leavesDataThatIsNotLastToTheParser) {
  // Field 1 of the chunk after field 3.
  const std::string inner =
      "\x1a\x03"
      "012"
      "\x08\x00";
  std::string bytes = chunk(0, 0, "012").substr(0, 1);
  bytes += char(inner.size() + 1);
  expectLeft(bytes + inner + std::string(1, '\0'));
}

TEST_F(ReadChunk, leavesEveryBeginningOfAChunkToTheParser) {
  const std::string whole = chunk(0, 300, "0123");
  for (size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(read(whole.substr(0, size)).has_value()) << size;
  }
}

}  // namespace
}  // namespace viewloom::read_chunk_test
