// SPDX-License-Identifier: Apache-2.0
#include "decode/frame_assembly.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/thread_time.h"

namespace viewloom::frame_assembly_test {
namespace {

// Planes of 6 and 4 bytes on the wire, depth first.
FrameFormat twoPlanes() {
  LayerFormat layer;
  layer.depth_first = true;
  layer.depth.kind = PlaneKind::kDepth;
  layer.depth.wire_bytes = 6;
  layer.color.wire_bytes = 4;
  return {.number = 7, .sources = {{.layers = {layer}}}};
}

class FrameAssemblyTest : public testing::Test {
 protected:
  std::string fieldAfter(uint32_t plane_index, uint64_t offset_bytes, std::string_view data) {
    const absl::Status status = assembly_.addChunk(plane_index, offset_bytes, data);
    EXPECT_TRUE(status.ok() || status.code() == absl::StatusCode::kInvalidArgument);
    return fieldOf(status);
  }

  BytePool pool_{4};
  FrameAssembly assembly_{twoPlanes(), pool_};
};

TEST_F(FrameAssemblyTest, joinsPiecesInTheOrderOfTheWire) {
  EXPECT_TRUE(assembly_.addChunk(0, 0, "abc").ok());
  EXPECT_TRUE(assembly_.addChunk(0, 3, "def").ok());
  EXPECT_FALSE(assembly_.complete());
  EXPECT_TRUE(assembly_.addChunk(1, 0, "ghij").ok());
  ASSERT_TRUE(assembly_.complete());
  const CollectedFrame frame = assembly_.take();
  ASSERT_EQ(frame.planes.size(), 2U);
  EXPECT_EQ(std::string(frame.planes[0]->begin(), frame.planes[0]->end()), "abcdef");
  EXPECT_EQ(std::string(frame.planes[1]->begin(), frame.planes[1]->end()), "ghij");
  EXPECT_EQ(frame.format.number, 7U);
}

TEST_F(FrameAssemblyTest, refusesAPlaneThatIsNotDue) {
  EXPECT_EQ(fieldAfter(1, 0, "a"), "chunk.plane_index");
  EXPECT_EQ(fieldAfter(4000000000, 0, "a"), "chunk.plane_index");
}

TEST_F(FrameAssemblyTest, refusesGapsAndRepetitions) {
  EXPECT_EQ(fieldAfter(0, 1, "a"), "chunk.offset_bytes");
  EXPECT_EQ(fieldAfter(0, 0, "abc"), "");
  EXPECT_EQ(fieldAfter(0, 0, "abc"), "chunk.offset_bytes");
  EXPECT_EQ(fieldAfter(0, ~uint64_t{0}, "abc"), "chunk.offset_bytes");
}

TEST_F(FrameAssemblyTest, refusesEmptyAndOversizedPieces) {
  EXPECT_EQ(fieldAfter(0, 0, ""), "chunk.data");
  EXPECT_EQ(fieldAfter(0, 0, std::string(kChunkBytesMax + 1, 'a')), "chunk.data");
}

TEST_F(FrameAssemblyTest, refusesTheByteBeyondThePlane) {
  EXPECT_EQ(fieldAfter(0, 0, "abcdefg"), "chunk.data");
  EXPECT_EQ(fieldAfter(0, 0, "abcde"), "");
  EXPECT_EQ(fieldAfter(0, 5, "fg"), "chunk.data");
}

TEST_F(FrameAssemblyTest, isCompleteAlsoOnceItsFrameIsTaken) {
  EXPECT_EQ(fieldAfter(0, 0, "abcdef"), "");
  EXPECT_EQ(fieldAfter(1, 0, "abcd"), "");
  assembly_.take();
  EXPECT_EQ(assembly_.requireComplete(), absl::OkStatus());
  EXPECT_EQ(fieldAfter(0, 0, "a"), "chunk.plane_index");
}

TEST_F(FrameAssemblyTest, refusesAnyPieceAfterTheLast) {
  EXPECT_EQ(fieldAfter(0, 0, "abcdef"), "");
  EXPECT_EQ(fieldAfter(1, 0, "abcd"), "");
  EXPECT_EQ(fieldAfter(2, 0, "a"), "chunk.plane_index");
  EXPECT_EQ(fieldAfter(1, 4, "a"), "chunk.plane_index");
}

// Bytes that a larger frame left behind do not show in a smaller one.
TEST_F(FrameAssemblyTest, ownsNothingOfTheFrameBefore) {
  FrameFormat large = twoPlanes();
  large.sources[0].layers[0].depth.wire_bytes = 9;
  FrameAssembly before(large, pool_);
  EXPECT_TRUE(before.addChunk(0, 0, "ABCDEFGHI").ok());
  EXPECT_TRUE(before.addChunk(1, 0, "JKLM").ok());
  before.take();
  EXPECT_TRUE(assembly_.addChunk(0, 0, "abc").ok());
  EXPECT_TRUE(assembly_.addChunk(0, 3, "def").ok());
  EXPECT_TRUE(assembly_.addChunk(1, 0, "ghij").ok());
  const CollectedFrame frame = assembly_.take();
  EXPECT_EQ(std::string(frame.planes[0]->begin(), frame.planes[0]->end()), "abcdef");
}

// Publishers cut chunks, and the network cuts pieces.
TEST_F(FrameAssemblyTest, widensRgbWhereverItIsCut) {
  FrameFormat format = twoPlanes();
  PlaneFormat& color = format.sources[0].layers[0].color;
  color.encoding = PlaneEncoding::kRgb8;
  color.size_px = {3, 2};
  color.wire_bytes = 18;
  const std::string wire = "abcdefghijklmnopqr";
  for (size_t chunk_bytes = 1; chunk_bytes <= wire.size(); ++chunk_bytes) {
    for (size_t piece_bytes = 1; piece_bytes <= chunk_bytes; ++piece_bytes) {
      BytePool pool(0);  // so that no buffer holds the bytes of another turn
      FrameAssembly assembly(format, pool);
      EXPECT_TRUE(assembly.addChunk(0, 0, "abcdef").ok());
      for (size_t at = 0; at < wire.size(); at += chunk_bytes) {
        std::string chunk = wire.substr(at, chunk_bytes);
        ASSERT_TRUE(assembly.beginChunk(1, at, chunk.size()).ok());
        for (; !chunk.empty(); chunk.erase(0, piece_bytes)) {
          const std::string piece = chunk.substr(0, piece_bytes);
          assembly.append(std::vector<uint8_t>(piece.begin(), piece.end()));
        }
      }
      const CollectedFrame frame = assembly.take();
      EXPECT_EQ(std::string(frame.planes[1]->begin(), frame.planes[1]->end()),
                "abc\xff"
                "def\xff"
                "ghi\xff"
                "jkl\xff"
                "mno\xff"
                "pqr\xff");
      const PlaneFormat& kept = frame.format.sources[0].layers[0].color;
      EXPECT_EQ(kept.encoding, PlaneEncoding::kRgba8);
      EXPECT_EQ(kept.wire_bytes, 24U);
    }
  }
}

TEST_F(FrameAssemblyTest, widensEveryPlaneOfRgb) {
  FrameFormat format = twoPlanes();
  LayerFormat& layer = format.sources[0].layers[0];
  layer.others.push_back({.kind = PlaneKind::kSpecular,
                          .encoding = PlaneEncoding::kRgb8,
                          .size_px = {2, 1},
                          .stride_bytes = 6,  // as wide as its pixels
                          .wire_bytes = 6});
  FrameAssembly assembly(format, pool_);
  EXPECT_TRUE(assembly.addChunk(0, 0, "abcdef").ok());
  EXPECT_TRUE(assembly.addChunk(1, 0, "ghij").ok());
  EXPECT_TRUE(assembly.addChunk(2, 0, "klmnop").ok());
  const CollectedFrame frame = assembly.take();
  EXPECT_EQ(std::string(frame.planes[2]->begin(), frame.planes[2]->end()),
            "klm\xff"
            "nop\xff");
  const PlaneFormat& kept = frame.format.sources[0].layers[0].others[0];
  EXPECT_EQ(kept.encoding, PlaneEncoding::kRgba8);
  EXPECT_EQ(kept.stride_bytes, 0U);
}

TEST_F(FrameAssemblyTest, countsTheTimeOfEachChunkAlone) {
  const int64_t begun_ns = threadTimeNs();
  ASSERT_TRUE(assembly_.addChunk(0, 0, "abcdef").ok());
  const int64_t between_ns = threadTimeNs();
  while (threadTimeNs() - between_ns < 20'000'000) continue;  // what others do on this thread
  const int64_t again_ns = threadTimeNs();
  ASSERT_TRUE(assembly_.addChunk(1, 0, "ghij").ok());
  const int64_t chunks_ns = threadTimeNs() - again_ns + between_ns - begun_ns;
  const CollectedFrame frame = assembly_.take();
  EXPECT_GT(frame.arrival_ns, 0);
  EXPECT_LE(frame.arrival_ns, chunks_ns);
}

TEST_F(FrameAssemblyTest, keepsRgbWithGapsAsItComes) {
  FrameFormat format = twoPlanes();
  PlaneFormat& color = format.sources[0].layers[0].color;
  color.encoding = PlaneEncoding::kRgb8;
  color.size_px = {1, 1};
  color.stride_bytes = 4;
  FrameAssembly assembly(format, pool_);
  EXPECT_TRUE(assembly.addChunk(0, 0, "abcdef").ok());
  EXPECT_TRUE(assembly.addChunk(1, 0, "ghij").ok());
  const CollectedFrame frame = assembly.take();
  EXPECT_EQ(std::string(frame.planes[1]->begin(), frame.planes[1]->end()), "ghij");
  EXPECT_EQ(frame.format.sources[0].layers[0].color.encoding, PlaneEncoding::kRgb8);
}

TEST_F(FrameAssemblyTest, tellsWhatIsMissing) {
  EXPECT_TRUE(assembly_.addChunk(0, 0, "ab").ok());
  const absl::Status status = assembly_.requireComplete();
  EXPECT_EQ(fieldOf(status), "header");
  EXPECT_EQ(status.message(),
            "header: a header came before the end of frame 7: plane 0 has 2 of 6 bytes; send the "
            "rest first");
}

}  // namespace
}  // namespace viewloom::frame_assembly_test
