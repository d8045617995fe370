// SPDX-License-Identifier: Apache-2.0
// Deep files that are not what they say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>
#include <random>

#include "files/deep_exr.h"
#include "support/deep_exr_writer.h"
#include "support/large_allocations.h"
#include "unit/client/test_files.h"

namespace viewloom::files::deep_exr_hostile_test {
namespace {

using Imath::Box2i;
using Imath::V2i;
using test::DeepFileOptions;
using test::DeepPicture;
using test::DeepPixel;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr int kWidth = 5, kHeight = 3;

// Every pixel has two samples.
DeepPicture smallPicture() {
  const Box2i window(V2i(0, 0), V2i(kWidth - 1, kHeight - 1));
  const deep::DeepSample near{.z_m = 1, .z_back_m = 2, .alpha = 0.5F, .color = {0.5F, 0.25F, 0}};
  const deep::DeepSample far{.z_m = 4, .z_back_m = 4, .alpha = 1, .color = {0, 0.25F, 1}};
  return {.data = window,
          .display = window,
          .pixels = std::vector<DeepPixel>(kWidth * kHeight, DeepPixel{near, far})};
}

class HostileDeepExr : public ::testing::Test {
 protected:
  std::string goodBytes(const DeepFileOptions& options) const {
    test::writeDeepExr(folder_.path() / "good.exr", smallPicture(), options);
    return bytesOf(folder_.path() / "good.exr");
  }

  // Reads all of it; what is visited must lie in the picture, whatever the bytes.
  absl::Status read(const std::string& bytes) const {
    absl::StatusOr<DeepExr> file = DeepExr::open(folder_.write("bad.exr", bytes), {});
    if (!file.ok()) return file.status();
    return file->forEachRow([&](const DeepRow& row) {
      ASSERT_LT(row.y, file->heightPx());
      ASSERT_LE(row.x + row.counts.size(), file->widthPx());
      ASSERT_EQ(std::accumulate(row.counts.begin(), row.counts.end(), size_t{0}),
                row.samples.size());
    });
  }

  std::string refusal(const std::string& bytes) const {
    const uint64_t before = test::largeAllocationCount();
    const absl::Status status = read(bytes);
    EXPECT_EQ(test::largeAllocationCount(), before) << "memory for what is refused";
    return status.ok() ? "OK" : std::string(status.message());
  }

  TestFolder folder_;
};

// Where the value of a header's attribute begins.
size_t valueOf(const std::string& bytes, const std::string& name, const std::string& type) {
  const std::string key = name + '\0' + type + '\0';
  const size_t at = bytes.find(key);
  EXPECT_NE(at, std::string::npos) << name;
  return at + key.size() + 4;
}

template <typename Number>
std::string with(std::string bytes, size_t at, Number number) {
  std::memcpy(&bytes.at(at), &number, sizeof number);
  return bytes;
}

uint64_t numberAt(const std::string& bytes, size_t at) {
  uint64_t number = 0;
  std::memcpy(&number, &bytes.at(at), sizeof number);
  return number;
}

// Where the table of chunks begins: it ends where the first chunk, row 0, begins.
size_t tableOf(const std::string& bytes, size_t chunk_count) {
  for (size_t at = 8; at + 8 * chunk_count <= bytes.size(); ++at) {
    if (numberAt(bytes, at) == at + 8 * chunk_count) return at;
  }
  ADD_FAILURE() << "no table";
  return 0;
}

// Byte offsets within a chunk of scan lines.
constexpr size_t kTableSizeAt = 4, kPackedSizeAt = 12, kUnpackedSizeAt = 20, kCountsAt = 28;

TEST_F(HostileDeepExr, isRefusedAtEveryLength) {
  for (const int tile_side_px : {0, 4}) {
    const std::string bytes = goodBytes({.tile_side_px = tile_side_px});
    ASSERT_TRUE(read(bytes).ok());
    for (size_t size = 0; size < bytes.size(); ++size) {
      ASSERT_THAT(refusal(bytes.substr(0, size)), HasSubstr("bad.exr: ")) << size;
    }
  }
}

TEST_F(HostileDeepExr, isRefusedByItsHeader) {
  const std::string good = goodBytes({});
  EXPECT_THAT(refusal("#?RADIANCE"), HasSubstr("begins with other bytes than an EXR file does"));
  EXPECT_THAT(refusal(with(good, 4, uint32_t{3})), HasSubstr("is of version 3"));
  const size_t window = valueOf(good, "dataWindow", "box2i");
  EXPECT_THAT(refusal(with(good, window + 12, 0x3FFFFFFF)),
              HasSubstr("the data window is 5x1073741824 px; accepted is 1..32768"));
  EXPECT_THAT(refusal(with(good, window, INT32_MIN)), HasSubstr("px; accepted is 1..32768"));
  EXPECT_THAT(refusal(with(good, window + 8, -1)), HasSubstr("the data window is 0x3 px"));
  EXPECT_THAT(refusal(with(good, window + 12, 32000)), HasSubstr("chunkCount is 3"));
  EXPECT_THAT(refusal(with(good, valueOf(good, "displayWindow", "box2i") + 8, 9000)),
              HasSubstr("9001x3 px; accepted is 1..8192"));
  EXPECT_THAT(refusal(with(good, valueOf(good, "compression", "compression"), uint8_t{4})),
              HasSubstr("compression is number 4; accepted for deep data are none"));
  EXPECT_THAT(refusal(with(good, valueOf(good, "compression", "compression") - 4, INT32_MAX)),
              HasSubstr("attribute compression has 2147483647 bytes, more than follow"));
  EXPECT_THAT(refusal(with(good, valueOf(good, "channels", "chlist") + 2, 9)),
              HasSubstr("channel A is of type 9"));
  EXPECT_THAT(refusal(with(good, valueOf(good, "channels", "chlist"), 'q')),
              HasSubstr("has no deep channel A; it has q, B, G, R, Z, ZBack"));
  EXPECT_THAT(refusal(with(good, valueOf(good, "type", "string"), 'x')),
              HasSubstr("has no deep part"));
  const std::string tiled = goodBytes({.tile_side_px = 4});
  EXPECT_THAT(refusal(with(tiled, valueOf(tiled, "tiles", "tiledesc"), 0)),
              HasSubstr("is deeptile with tiles of 0x4 px"));
  EXPECT_THAT(refusal(with(tiled, valueOf(tiled, "chunkCount", "int"), 1)),
              HasSubstr("chunkCount is 1; the data window has 2"));
}

TEST_F(HostileDeepExr, isRefusedByTheOffsetsOfItsChunks) {
  const std::string good = goodBytes({});
  const size_t table = tableOf(good, kHeight);
  EXPECT_THAT(refusal(with(good, table + 8, UINT64_MAX)), HasSubstr("row 1: its chunk at byte"));
  EXPECT_THAT(refusal(with(good, table + 8, uint64_t{good.size() - 3})),
              HasSubstr("row 1: its chunk at byte"));
  EXPECT_THAT(refusal(with(good, table + 8, numberAt(good, table))),
              AllOf(HasSubstr("row 1: the chunk at byte "), HasSubstr("is another one")));
  const std::string second = goodBytes({.is_second_part = true});
  EXPECT_THAT(refusal(with(second, valueOf(second, "chunkCount", "int"), INT32_MAX)),
              HasSubstr("offsets of chunks should begin after 17179869176"));
  EXPECT_THAT(refusal(with(second, valueOf(second, "chunkCount", "int"), -1)),
              HasSubstr("has no deep part that can be found"));
}

TEST_F(HostileDeepExr, isRefusedByTheSizesInAChunk) {
  const std::string good = goodBytes({.compression = Imf::NO_COMPRESSION});
  const auto chunk = static_cast<size_t>(numberAt(good, tableOf(good, kHeight)));
  EXPECT_THAT(refusal(with(good, chunk + kTableSizeAt, UINT64_MAX)), HasSubstr("row 0: its chunk"));
  EXPECT_THAT(refusal(with(good, chunk + kPackedSizeAt, UINT64_MAX)),
              HasSubstr("row 0: its chunk"));
  EXPECT_THAT(refusal(with(good, chunk + kTableSizeAt, uint64_t{4})),
              HasSubstr("row 0: sample counts: 4 bytes cannot be the 20 wanted"));
  // Two samples a pixel, of six floats.
  EXPECT_THAT(refusal(with(good, chunk + kUnpackedSizeAt, uint64_t{1} << 40)),
              HasSubstr("row 0: has 1099511627776 bytes for 10 samples of 24"));
  EXPECT_THAT(refusal(with(good, chunk + kPackedSizeAt, uint64_t{100})),
              HasSubstr("row 0: samples: 100 bytes cannot be the 240 wanted"));
}

TEST_F(HostileDeepExr, isRefusedByItsSampleCounts) {
  const std::string good = goodBytes({.compression = Imf::NO_COMPRESSION});
  const size_t counts = numberAt(good, tableOf(good, kHeight)) + kCountsAt;
  EXPECT_THAT(refusal(with(good, counts + 4, 1)),
              HasSubstr("row 0: px 1 is said to end at sample 1, the one before it at 2"));
  EXPECT_THAT(refusal(with(good, counts + 16, -1)),
              HasSubstr("row 0: px 4 is said to end at sample 4294967295"));
  EXPECT_THAT(refusal(with(good, counts + 16, 1 << 29)), HasSubstr("bytes for 536870912 samples"));
  // The byte count matches the counts: first over the limit, then more than the packed bytes hold.
  const uint64_t many = kDeepChunkBytesMax / 24 + 1;
  const std::string asked = with(good, counts + 16, static_cast<uint32_t>(many));
  const size_t unpacked_size = counts - kCountsAt + kUnpackedSizeAt;
  EXPECT_THAT(refusal(with(asked, unpacked_size, many * 24)), HasSubstr("accepted are up to"));
  const std::string less = with(good, counts + 16, uint32_t{1} << 20);
  EXPECT_THAT(refusal(with(less, unpacked_size, uint64_t{24} << 20)),
              HasSubstr("samples: 240 bytes cannot be the 25165824 wanted"));
}

TEST_F(HostileDeepExr, isRefusedByCompressedBytesThatGiveSomethingElse) {
  for (const Imf::Compression compression : {Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION}) {
    const std::string good = goodBytes({.compression = compression});
    const auto chunk = static_cast<size_t>(numberAt(good, tableOf(good, kHeight)));
    const size_t packed = chunk + kCountsAt + numberAt(good, chunk + kTableSizeAt);
    const uint64_t size = numberAt(good, chunk + kPackedSizeAt);
    ASSERT_LT(size, 240U) << "stored as it is";
    EXPECT_THAT(refusal(with(good, chunk + kPackedSizeAt, size - 1)),
                HasSubstr("row 0: samples: "));
    for (const int spoilt : {0x7F, 0x80, 0xFF}) {
      std::string bytes = good;
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(packed), size, char(spoilt));
      EXPECT_THAT(refusal(bytes), HasSubstr("row 0: samples: ")) << spoilt;
    }
  }
}

// Whatever the bytes, they are read or refused; sanitizers watch.
TEST_F(HostileDeepExr, isReadOrRefusedHoweverItWasSpoilt) {
  const unsigned seed = 31;
  std::mt19937 random(seed);
  int accepted_count = 0;
  constexpr int kRounds = 400;
  for (const DeepFileOptions& options :
       {DeepFileOptions{.compression = Imf::NO_COMPRESSION},
        DeepFileOptions{.compression = Imf::RLE_COMPRESSION, .tile_side_px = 4},
        DeepFileOptions{.compression = Imf::ZIPS_COMPRESSION, .is_second_part = true}}) {
    const std::string good = goodBytes(options);
    for (int round = 0; round < kRounds; ++round) {
      std::string bytes = good;
      for (uint32_t edits = 1 + random() % 4; edits > 0; --edits) {
        const size_t at = random() % bytes.size();
        if (random() % 4 == 0) bytes.erase(at, random() % 4);
        if (random() % 4 == 0) bytes.insert(at, random() % 9, static_cast<char>(random()));
        bytes[at % bytes.size()] = static_cast<char>(random() % 2 == 0 ? 0xFF : random());
      }
      accepted_count += read(bytes).ok();
    }
  }
  EXPECT_GT(accepted_count, 0);
  EXPECT_LT(accepted_count, 3 * kRounds);
}

}  // namespace
}  // namespace viewloom::files::deep_exr_hostile_test
