// SPDX-License-Identifier: Apache-2.0
#include "lib/color_decoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/client/chained_coder.h"

namespace viewloom::color_decoder_test {
namespace {

using test::kView_px;
using test::kViews;
using Coder = test::ChainedCoder;

void expectGreys(const absl::StatusOr<AtlasPicture>& picture, uint8_t grey) {
  ASSERT_TRUE(picture.ok()) << picture.status();
  ASSERT_EQ(picture->width_px, kViews * kView_px.width);
  const size_t middle = kView_px.height / 2 * size_t{picture->width_px};
  for (uint32_t view = 0; view < kViews; ++view) {
    const size_t x = view * kView_px.width + kView_px.width / 2;
    EXPECT_NEAR(picture->samples[3 * (middle + x)], grey + 20 * view, 1) << view;
  }
}

TEST(ColorDecoder, followsChainedAtlases) {
  Coder coder;
  ColorDecoder decoder;
  expectGreys(decoder.decode(coder.code(5, 0, 40)), 40);
  expectGreys(decoder.decode(coder.code(6, 5, 60)), 60);
  expectGreys(decoder.decode(coder.code(7, 6, 90)), 90);
  expectGreys(decoder.decode(coder.code(9, 0, 120)), 120);
  expectGreys(decoder.decode(coder.code(10, 9, 200)), 200);
}

TEST(ColorDecoder, refusesAnAtlasThatRefersToAMissingOne) {
  Coder coder;
  ColorDecoder decoder;
  const Atlas first = coder.code(1, 0, 40);
  const Atlas second = coder.code(2, 1, 60);
  const Atlas third = coder.code(3, 2, 90);
  expectGreys(decoder.decode(first), 40);
  const absl::Status refused = decoder.decode(third).status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(refused.message()),
              testing::HasSubstr("atlas 3 refers to atlas 2, which was not decoded"));
  EXPECT_FALSE(decoder.decode(second).ok()) << "after an error, none that refers to another";
  expectGreys(decoder.decode(coder.code(4, 0, 120)), 120);
}

TEST(ColorDecoder, refusesWhatFollowsWhereItWasMovedFrom) {
  Coder coder;
  ColorDecoder decoder;
  expectGreys(decoder.decode(coder.code(1, 0, 40)), 40);
  ColorDecoder other(std::move(decoder));
  const Atlas second = coder.code(2, 1, 60);
  expectGreys(other.decode(second), 60);
  // NOLINTNEXTLINE(bugprone-use-after-move): it is as one that has decoded nothing.
  EXPECT_EQ(decoder.decode(second).status().code(), absl::StatusCode::kFailedPrecondition);
}

TEST(ColorDecoder, refusesWhatFollowsADamagedAtlas) {
  Coder coder;
  ColorDecoder decoder;
  expectGreys(decoder.decode(coder.code(1, 0, 40)), 40);
  Atlas damaged = coder.code(2, 1, 60);
  damaged.bands[1].bytes = "no picture";
  EXPECT_EQ(decoder.decode(damaged).status().code(), absl::StatusCode::kDataLoss);
  EXPECT_EQ(decoder.decode(coder.code(3, 2, 90)).status().code(),
            absl::StatusCode::kFailedPrecondition);
  expectGreys(decoder.decode(coder.code(4, 0, 120)), 120);
}

TEST(ColorDecoder, isNeededOnlyForAtlasesThatReferToOthers) {
  Coder coder;
  expectGreys(decodePlane(coder.code(1, 0, 40), v1::ATLAS_PLANE_COLOR), 40);
  const absl::Status refused = decodePlane(coder.code(2, 1, 60), v1::ATLAS_PLANE_COLOR).status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(refused.message()), testing::HasSubstr("ColorDecoder"));
}

}  // namespace
}  // namespace viewloom::color_decoder_test
