// SPDX-License-Identifier: Apache-2.0
#include "mp4/movie_head.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/mp4/box_reader.h"
#include "unit/mp4/coded_movie.h"
#include "video/annex_b.h"

namespace viewloom::test::movie_head_test {
namespace {

using testing::ElementsAre;

AvcTrack track() {
  const auto read = readAvcTrack(codedMovie(1, 1).front());
  EXPECT_TRUE(read.ok()) << read.status();
  return *read;
}

std::vector<std::string> typesOf(const std::vector<Box>& boxes) {
  std::vector<std::string> types;
  for (const Box& box : boxes) types.push_back(box.type);
  return types;
}

const std::vector<MovieSample> kSamples = {
    {.size_bytes = 1000, .duration_ticks = 3000, .is_sync = true},
    {.size_bytes = 100, .duration_ticks = 3000, .is_sync = false},
    {.size_bytes = 120, .duration_ticks = 9000, .is_sync = false},
    {.size_bytes = 900, .duration_ticks = 1, .is_sync = true},
    {.size_bytes = 80, .duration_ticks = 90000, .is_sync = false}};

TEST(MovieHead, standsBeforeThePictures) {
  const std::vector<uint8_t> head = makeMovieHead(track(), {}, kSamples);
  const std::vector<Box> boxes = boxesOf(head, 0, true);
  EXPECT_THAT(typesOf(boxes), ElementsAre("ftyp", "moov", "mdat"));
  EXPECT_EQ(boxes.back().content_begin, head.size());
  EXPECT_EQ(bigEndian(head, boxes.back().begin, 4), 8U + 2200U);
  EXPECT_THAT(typesOf(boxesOf(boxAt(head, "moov/trak/mdia/minf/stbl").content)),
              ElementsAre("stsd", "stts", "stss", "stsc", "stsz", "stco"));
}

TEST(MovieHead, saysWhereWhenAndHowLongEachPictureIs) {
  const std::vector<uint8_t> head = makeMovieHead(track(), {}, kSamples);
  const std::vector<ReadSample> samples = samplesOf(head);
  ASSERT_EQ(samples.size(), kSamples.size());
  uint64_t offset = head.size();
  uint64_t begin_ticks = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].offset, offset) << i;
    EXPECT_EQ(samples[i].size, kSamples[i].size_bytes) << i;
    EXPECT_EQ(samples[i].begin_ticks, begin_ticks) << i;
    EXPECT_EQ(samples[i].duration_ticks, kSamples[i].duration_ticks) << i;
    EXPECT_EQ(samples[i].is_sync, kSamples[i].is_sync) << i;
    offset += kSamples[i].size_bytes;
    begin_ticks += kSamples[i].duration_ticks;
  }
  for (const char* header : {"moov/mvhd", "moov/trak/mdia/mdhd"}) {
    EXPECT_EQ(boxAt(head, header).number(12, 4), 90'000U) << header;
    EXPECT_EQ(boxAt(head, header).number(16, 4), begin_ticks) << header;
  }
  EXPECT_EQ(boxAt(head, "moov/trak/tkhd").number(20, 4), begin_ticks);
}

TEST(MovieHead, describesThePictures) {
  const AvcTrack track = movie_head_test::track();
  const std::vector<uint8_t> head = makeMovieHead(track, {}, kSamples);
  const Box track_header = boxAt(head, "moov/trak/tkhd");
  EXPECT_EQ(track_header.number(76, 4), kMovieSize_px.width << 16);
  EXPECT_EQ(track_header.number(80, 4), kMovieSize_px.height << 16);
  EXPECT_EQ(sampleEntry(head).number(24, 2), kMovieSize_px.width);
  EXPECT_EQ(sampleEntry(head).number(26, 2), kMovieSize_px.height);
  const Box configuration = entryBox(head, "avcC");
  EXPECT_THAT(configuration.content.first(6),
              ElementsAre(1, track.sets.sequence[1], track.sets.sequence[2], track.sets.sequence[3],
                          0xFF, 0xE1));
  const std::vector<Bytes> sets = setsOf(head);
  EXPECT_THAT(track.sets.sequence, testing::ElementsAreArray(sets[0]));
  EXPECT_THAT(track.sets.picture, testing::ElementsAreArray(sets[1]));
  const Box color = entryBox(head, "colr");
  EXPECT_THAT(color.content, ElementsAre('n', 'c', 'l', 'x', 0, 1, 0, 13, 0, 6, 0x80))
      << "the colour of the parameter set: sRGB, BT.601, full range";
}

TEST(MovieHead, hasTags) {
  const std::vector<uint8_t> head = makeMovieHead(
      track(), {.title = "demo", .comment = "{\"LKGRows\":6}", .tool = "viewloom"}, kSamples);
  EXPECT_EQ(tagOf(head, "\xA9nam"), "demo");
  EXPECT_EQ(tagOf(head,
                  "\xA9"
                  "cmt"),
            "{\"LKGRows\":6}");
  EXPECT_EQ(tagOf(head, "\xA9too"), "viewloom");
  EXPECT_FALSE(findBox(makeMovieHead(track(), {}, kSamples), "moov/udta").has_value());
}

TEST(MovieHead, hasLargeOffsetsAndTimesWhereItNeedsThem) {
  std::vector<MovieSample> samples(
      9, {.size_bytes = 1'000'000'000, .duration_ticks = 0xF0000000, .is_sync = true});
  const std::vector<uint8_t> head = makeMovieHead(track(), {}, samples);
  const std::vector<ReadSample> read = samplesOf(head);
  EXPECT_EQ(read[8].offset, head.size() + 8'000'000'000);
  EXPECT_EQ(boxAt(head, "moov/mvhd").version(), 1);
  EXPECT_EQ(boxAt(head, "moov/mvhd").number(24, 8), 9ULL * 0xF0000000);
  EXPECT_EQ(boxAt(head, "moov/trak/tkhd").number(28, 8), 9ULL * 0xF0000000);
  EXPECT_EQ(boxAt(head, "moov/trak/mdia/mdhd").number(24, 8), 9ULL * 0xF0000000);
  const Box data = boxesOf(head, 0, true).back();
  EXPECT_EQ(data.type, "mdat");
  EXPECT_EQ(bigEndian(head, data.begin + 8, 8), 9'000'000'016U);

  samples.resize(4);  // less than 4 GiB, and more than that with the head
  samples.push_back({.size_bytes = 0xFFFFFFFF - 4'000'000'000U - 8, .is_sync = true});
  const std::vector<uint8_t> edge = makeMovieHead(track(), {}, samples);
  EXPECT_EQ(samplesOf(edge)[4].offset, edge.size() + 4'000'000'000);
  EXPECT_TRUE(findBox(edge, "moov/trak/mdia/minf/stbl/co64").has_value());
}

TEST(AvcTrack, refusesStreamsThatNoFileCanHold) {
  const std::vector<std::vector<uint8_t>> units = codedMovie(2, 2);
  EXPECT_FALSE(readAvcTrack(units[1]).ok()) << "without parameter sets";
  EXPECT_FALSE(readAvcTrack({}).ok());
  const AvcTrack track = *readAvcTrack(units[0]);
  EXPECT_FALSE(makeAvcSample({}, track.sets).ok());
  AvcParameterSets others = track.sets;
  others.sequence.back() ^= 0xFF;
  EXPECT_EQ(makeAvcSample(units[0], others).status().code(), absl::StatusCode::kInvalidArgument);
  const auto sample = makeAvcSample(units[1], track.sets);
  ASSERT_TRUE(sample.ok()) << sample.status();
  EXPECT_FALSE(sample->is_sync);
}

TEST(AvcTrack, keepsEverythingButTheSets) {
  const std::vector<std::vector<uint8_t>> units = codedMovie(1, 1);
  const AvcTrack track = *readAvcTrack(units[0]);
  EXPECT_EQ(track.parameters.size_px, kMovieSize_px);
  const auto sample = makeAvcSample(units[0], track.sets);
  ASSERT_TRUE(sample.ok()) << sample.status();
  EXPECT_TRUE(sample->is_sync);
  const std::vector<uint8_t> stream =
      annexB(sample->bytes, {track.sets.sequence, track.sets.picture});
  const std::vector<NalUnit> before = nalUnits(units[0]);
  const std::vector<NalUnit> after = nalUnits(stream);
  ASSERT_EQ(before.size(), after.size());
  for (size_t i = 0; i < before.size(); ++i) {
    EXPECT_THAT(after[i].bytes, testing::ElementsAreArray(before[i].bytes)) << i;
  }
}

}  // namespace
}  // namespace viewloom::test::movie_head_test
