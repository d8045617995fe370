// SPDX-License-Identifier: Apache-2.0
// Messages of a publisher that do not follow on, and bytes that do not decode.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "e2e/bystander.h"
#include "e2e/refusal.h"
#include "unit/decode/h264_samples.h"
#include "unit/decode/jpeg_samples.h"
#include "unit/decode/zstd_samples.h"

namespace viewloom::rpc_bad_chunks_test {
namespace {

using ::testing::HasSubstr;

constexpr auto kInvalid = grpc::StatusCode::INVALID_ARGUMENT;
constexpr size_t kColorBytes = 48;
constexpr size_t kDepthBytes = 64;

struct BadSequence {
  const char* name;
  std::function<void(TestPublisher&)> send;  // to a call without settings
  Refusal refusal;
};

std::string bytes(size_t count) {
  return std::string(count, 'x');
}

void begin(TestPublisher& publisher) {
  publisher.sendSettings("bad");
  publisher.sendHeader(smallHeader(1));
}

const std::vector<BadSequence> kSettings = {
    {"header first", [](auto& p) { p.sendHeader(smallHeader(1)); }, {kInvalid, "header"}},
    {"chunk first", [](auto& p) { p.sendChunk(chunkOf(0, 0, "x")); }, {kInvalid, "chunk"}},
    {"nothing at all", [](auto& p) { p.halfClose(); }, {kInvalid, "settings"}},
    {"an empty message", [](auto& p) { p.send({}); }, {kInvalid, "message"}},
    {"settings twice",
     [](auto& p) {
       p.sendSettings("bad");
       p.sendSettings("bad");
     },
     {kInvalid, "settings"}},
    {"no name", [](auto& p) { p.sendSettings(""); }, {kInvalid, "settings.stream"}},
    {"a long name", [](auto& p) { p.sendSettings(bytes(65)); }, {kInvalid, "settings.stream"}},
    {"a path", [](auto& p) { p.sendSettings("../etc"); }, {kInvalid, "settings.stream"}},
    {"a long secret",
     [](auto& p) { p.sendSettings("bad", bytes(129)); },
     {kInvalid, "settings.session_id"}},
    {"a second publisher",
     [](auto& p) { p.sendSettings("healthy"); },
     {grpc::StatusCode::ALREADY_EXISTS, "settings.stream"}},
    {"a second publisher with a guess",
     [](auto& p) { p.sendSettings("healthy", "guess"); },
     {grpc::StatusCode::ALREADY_EXISTS, "settings.stream"}},
};

const std::vector<BadSequence> kChunks = {
    {"chunk before header",
     [](auto& p) {
       p.sendSettings("bad");
       p.sendChunk(chunkOf(0, 0, "x"));
     },
     {kInvalid, "chunk"}},
    {"second plane first",
     [](auto& p) {
       begin(p);
       p.sendChunk(chunkOf(1, 0, bytes(kDepthBytes)));
     },
     {kInvalid, "chunk.plane_index"}},
    {"no such plane",
     [](auto& p) {
       begin(p);
       p.sendChunk(chunkOf(~0u, 0, "x"));
     },
     {kInvalid, "chunk.plane_index"}},
    {"a gap",
     [](auto& p) {
       begin(p);
       p.sendChunk(chunkOf(0, 1, "x"));
     },
     {kInvalid, "chunk.offset_bytes"}},
    {"the same piece twice",
     [](auto& p) {
       begin(p);
       p.sendChunk(chunkOf(0, 0, "x"));
       p.sendChunk(chunkOf(0, 0, "x"));
     },
     {kInvalid, "chunk.offset_bytes"}},
    {"an offset that overflows",
     [](auto& p) {
       begin(p);
       p.sendChunk(chunkOf(0, ~uint64_t{0}, bytes(2)));
     },
     {kInvalid, "chunk.offset_bytes"}},
    {"an empty chunk",
     [](auto& p) {
       begin(p);
       p.sendChunk(chunkOf(0, 0, ""));
     },
     {kInvalid, "chunk.data"}},
    {"one byte too many",
     [](auto& p) {
       begin(p);
       p.sendChunk(chunkOf(0, 0, bytes(kColorBytes + 1)));
     },
     {kInvalid, "chunk.data"}},
    {"over 1 MiB",
     [](auto& p) {
       begin(p);
       p.sendChunk(chunkOf(0, 0, bytes((1 << 20) + 1)));
     },
     {kInvalid, "chunk.data"}},
    {"one chunk too many",
     [](auto& p) {
       p.sendSettings("bad");
       p.sendFrame(1);
       p.sendChunk(chunkOf(1, kDepthBytes, "x"));
     },
     {kInvalid, "chunk.plane_index"}},
    {"the next header too early",
     [](auto& p) {
       begin(p);
       p.sendChunk(chunkOf(0, 0, bytes(kColorBytes)));
       p.sendHeader(smallHeader(2));
     },
     {kInvalid, "header"}},
    {"closed within a frame",
     [](auto& p) {
       begin(p);
       p.halfClose();
     },
     {kInvalid, "chunk"}},
    {"a number again",
     [](auto& p) {
       p.sendSettings("bad");
       p.sendFrame(3);
       p.sendHeader(smallHeader(3));
     },
     {grpc::StatusCode::OUT_OF_RANGE, "header.number"}},
    {"a number that goes back",
     [](auto& p) {
       p.sendSettings("bad");
       p.sendFrame(3);
       p.sendHeader(smallHeader(2));
     },
     {grpc::StatusCode::OUT_OF_RANGE, "header.number"}},
    {"a message over 2 MiB",
     [](auto& p) {
       begin(p);
       p.sendChunk(chunkOf(0, 0, bytes(2 << 20)));
     },
     {grpc::StatusCode::RESOURCE_EXHAUSTED, ""}},
};

void expectRefused(const std::vector<BadSequence>& cases) {
  TestServer server;
  Bystander bystander(server);
  for (const BadSequence& bad : cases) {
    SCOPED_TRACE(bad.name);
    TestPublisher publisher(server.connect());
    bad.send(publisher);
    EXPECT_EQ(refusalOf(publisher.finish()), bad.refusal);
    bystander.expectUndisturbed();
  }
}

TEST(PublishFrames, refusesBadSettings) {
  expectRefused(kSettings);
}
TEST(PublishFrames, refusesChunksAndHeadersThatDoNotFollowOn) {
  expectRefused(kChunks);
}

TEST(PublishFrames, refusesMoreStreamsThanItTakes) {
  TestServer server({}, 2);
  Bystander bystander(server);
  TestPublisher second(server.connect(), "second");
  TestPublisher third(server.connect());
  third.sendSettings("third");
  EXPECT_EQ(refusalOf(third.finish()),
            (Refusal{grpc::StatusCode::RESOURCE_EXHAUSTED, "settings.stream"}));
  bystander.expectUndisturbed();
}

// Colour of 16x16 px that passes the header's checks but not its decoder.
struct BadBytes {
  const char* name;
  v1::PlaneEncoding encoding;
  v1::PlaneCompression compression;
  std::vector<uint8_t> bytes;
  const char* reason;
};

constexpr SizePx kSize{16, 16};
constexpr size_t kRgbBytes = 16 * 16 * 3;

std::vector<uint8_t> truncated(std::vector<uint8_t> bytes) {
  bytes.resize(bytes.size() / 2);
  return bytes;
}

std::vector<BadBytes> badBytes() {
  const auto jpeg = v1::PLANE_ENCODING_JPEG;
  const auto video = v1::PLANE_ENCODING_H264;
  const auto rgb = v1::PLANE_ENCODING_RGB8;
  const auto none = v1::PLANE_COMPRESSION_NONE;
  const auto zstd = v1::PLANE_COMPRESSION_ZSTD;
  const std::vector<uint8_t> exact(kRgbBytes, 7);
  const std::vector<uint8_t> longer(kRgbBytes + 1, 7);
  const std::vector<uint8_t> shorter(kRgbBytes - 1, 7);
  const std::vector<uint8_t> bomb(size_t{16} << 20, 0);  // packs to less than a header admits
  return {
      {"progressive", jpeg, none, sampleJpeg(kSize, JpegSort::kProgressive), "progressive"},
      {"arithmetic", jpeg, none, sampleJpeg(kSize, JpegSort::kArithmetic), "arithmetic"},
      {"CMYK", jpeg, none, sampleJpeg(kSize, JpegSort::kCmyk), "CMYK"},
      {"of another size", jpeg, none, sampleJpeg({16, 8}, JpegSort::kBaseline), "16x8"},
      {"cut short", jpeg, none, truncated(sampleJpeg(kSize, JpegSort::kBaseline)), "JPEG"},
      {"no JPEG", jpeg, none, exact, "JPEG"},
      {"video of another size", video, none, sampleH264({16, 32}), "16x32 px at row 0"},
      {"video that refers to others", video, none, dependentH264(kSize), "key frame"},
      {"video of limited range", video, none, x264LimitedRange(), "limited range"},
      {"video cut short", video, none, truncated(sampleH264(kSize)), "send both"},
      {"a bomb of video", video, none, sampleH264({1024, 1024}, {.qp = 51}),
       "1024x1024 px at row 0"},
      {"no video", video, none, exact, "0 rows together"},
      {"one byte more than declared", rgb, zstd, zstdFrame(longer, ZstdSize::kOpen), "768"},
      {"one byte less than declared", rgb, zstd, zstdFrame(shorter, ZstdSize::kOpen), "768"},
      {"a bomb that owns up", rgb, zstd, zstdFrame(bomb, ZstdSize::kStated), "768"},
      {"a bomb that does not", rgb, zstd, zstdFrame(bomb, ZstdSize::kOpen), "768"},
      {"no zstd", rgb, zstd, std::vector<uint8_t>(64, 9), "zstd"},
  };
}

v1::FrameHeader headerFor(const BadBytes& bad, uint64_t number) {
  v1::FrameHeader header = smallHeader(number);
  v1::Plane& color = *header.mutable_sources(0)->mutable_layers(0)->mutable_planes(0);
  color.mutable_size()->set_width(kSize.width);
  color.mutable_size()->set_height(kSize.height);
  color.set_encoding(bad.encoding);
  color.set_compression(bad.compression);
  color.set_bytes_count(bad.bytes.size());
  return header;
}

TEST(PublishFrames, reportsFramesThatDoNotDecodeAndGoesOn) {
  TestServer server;
  Bystander bystander(server);
  TestPublisher publisher(server.connect(), "bad");
  uint64_t number = 0;
  for (const BadBytes& bad : badBytes()) {
    SCOPED_TRACE(bad.name);
    ASSERT_TRUE(publisher.sendHeader(headerFor(bad, ++number)));
    ASSERT_TRUE(
        publisher.sendChunk(chunkOf(0, 0, std::string(bad.bytes.begin(), bad.bytes.end()))));
    ASSERT_TRUE(publisher.sendChunk(chunkOf(1, 0, bytes(kDepthBytes))));
    const auto report = publisher.readReport();
    ASSERT_TRUE(report.has_value());
    EXPECT_EQ(report->number(), number);
    EXPECT_EQ(report->outcome(), v1::FRAME_OUTCOME_REFUSED);
    EXPECT_FALSE(report->has_stats());
    EXPECT_THAT(report->reason(), HasSubstr("sources[0].layers[0].planes[0]"));
    EXPECT_THAT(report->reason(), HasSubstr(bad.reason));
    bystander.expectUndisturbed();
  }
  ASSERT_TRUE(publisher.sendFrame(++number));
  EXPECT_EQ(publisher.readReport()->outcome(), v1::FRAME_OUTCOME_BUILT_WITHOUT_DISPLAY);
}

}  // namespace
}  // namespace viewloom::rpc_bad_chunks_test
