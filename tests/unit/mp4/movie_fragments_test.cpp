// SPDX-License-Identifier: Apache-2.0
#include "mp4/movie_fragments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/mp4/box_reader.h"
#include "unit/mp4/coded_movie.h"
#include "video/openh264_decoder.h"

namespace viewloom::test::movie_fragments_test {
namespace {

std::vector<uint8_t> joined(std::initializer_list<std::vector<uint8_t>> parts) {
  std::vector<uint8_t> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST(MovieFragments, beginWithADescriptionWithoutPictures) {
  const AvcTrack track = *readAvcTrack(codedMovie(1, 1).front());
  const std::vector<uint8_t> head = makeFragmentsHead(track, {.comment = "{}"});
  EXPECT_EQ(boxesOf(head).size(), 2U);
  EXPECT_EQ(boxAt(head, "moov/mvhd").number(16, 4), 0U) << "the length is not known";
  EXPECT_EQ(boxAt(head, "moov/mvex/trex").number(4, 4), 1U);
  EXPECT_EQ(boxAt(head, "moov/trak/mdia/minf/stbl/stsz").number(8, 4), 0U);
  EXPECT_EQ(setsOf(head).size(), 2U);
  EXPECT_EQ(tagOf(head,
                  "\xA9"
                  "cmt"),
            "{}");
}

TEST(MovieFragments, saysTimeSizeAndKindOfEachPicture) {
  const std::vector<std::vector<uint8_t>> units = codedMovie(2, 2);
  const AvcTrack track = *readAvcTrack(units[0]);
  const auto decoder = *OpenH264Decoder::make();
  for (uint32_t i = 0; i < 2; ++i) {
    const AvcSample sample = *makeAvcSample(units[i], track.sets);
    const uint64_t begin_ticks = 0x1'0000'0000 + i;
    const std::vector<uint8_t> fragment = joined(
        {makeFragmentHead(
             sample, {.number = i + 1, .begin_ticks = begin_ticks, .duration_ticks = 3000 + i}),
         sample.bytes});
    EXPECT_EQ(boxAt(fragment, "moof/mfhd").number(4, 4), i + 1);
    EXPECT_EQ(boxAt(fragment, "moof/traf/tfhd").number(0, 4), 0x020000U);
    EXPECT_EQ(boxAt(fragment, "moof/traf/tfdt").number(4, 8), begin_ticks);
    const Box run = boxAt(fragment, "moof/traf/trun");
    EXPECT_EQ(run.number(0, 4), 0x701U);
    EXPECT_EQ(run.number(4, 4), 1U);
    EXPECT_EQ(run.number(12, 4), 3000 + i);
    EXPECT_EQ(run.number(20, 4), i == 0 ? 0x02000000U : 0x01010000U);
    const auto data = std::span(fragment).subspan(run.number(8, 4));
    EXPECT_EQ(data.size(), run.number(16, 4));
    const std::vector<Bytes> sets =
        i == 0 ? std::vector<Bytes>{track.sets.sequence, track.sets.picture} : std::vector<Bytes>();
    const auto picture = decoder->decode(annexB(data, sets), kMovieSize_px);
    EXPECT_TRUE(picture.ok()) << picture.status();
  }
}

}  // namespace
}  // namespace viewloom::test::movie_fragments_test
