// SPDX-License-Identifier: Apache-2.0
// Encoders whose quantisation changes between two pictures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/video/sample_picture.h"
#include "unit/video/planned_encoder.h"
#include "video/annex_b.h"
#include "video/encoder_choice.h"
#include "video/openh264_decoder.h"
#include "video/openh264_encoder.h"
#include "video/quantisation.h"

namespace viewloom::test::quantisation_test {
namespace {

constexpr SizePx kSize_px{322, 202};

struct Coded {
  bool is_idr;
  size_t size_bytes;
  double psnr_db;
};

// A texture that moves by 2 px from picture to picture, each with its own quantisation. All but the
// first refer to the one before, if the encoder does as it is asked.
std::vector<Coded> codedAt(VideoEncoder& encoder, const std::vector<uint32_t>& qps) {
  const auto decoder = OpenH264Decoder::make();
  std::vector<Coded> made;
  for (const uint32_t qp : qps) {
    const absl::Status set = encoder.setQp(qp);
    EXPECT_TRUE(set.ok()) << set;
    EXPECT_EQ(encoder.format().qp, qp);
    const SamplePicture sample = SamplePicture::texture(kSize_px, 2 * int(made.size()));
    const Reference reference = made.empty() ? Reference::kNone : Reference::kPictureBefore;
    std::vector<uint8_t> unit;
    const absl::Status status = encoder.encode(sample.video(), reference, unit);
    EXPECT_TRUE(status.ok()) << status;
    const auto picture = (*decoder)->decode(unit, kSize_px);
    EXPECT_TRUE(picture.ok()) << picture.status();
    if (!picture.ok()) return made;
    made.push_back({.is_idr = nalUnits(unit).back().type() == NalType::kIdrSlice,
                    .size_bytes = unit.size(),
                    .psnr_db = psnrOfLuma(*picture, sample.video())});
  }
  return made;
}

std::vector<bool> areIdr(const std::vector<Coded>& made) {
  std::vector<bool> are_idr;
  for (const Coded& coded : made) are_idr.push_back(coded.is_idr);
  return are_idr;
}

TEST(OpenH264, changesTheQuantisationWithoutAnotherIdrPicture) {
  for (const VideoFormat& format : {VideoFormat{.size_px = kSize_px, .qp = 24},
                                    VideoFormat{.size_px = kSize_px, .qp = 24, .thread_count = 2},
                                    VideoFormat{.size_px = kSize_px,
                                    .qp = 24,
                                    .slice_count = 3,
                                    .entropy = EntropyCoding::kVariableLength}}) {
    const auto encoder = OpenH264Encoder::make(format);
    ASSERT_TRUE(encoder.ok()) << encoder.status();
    const std::vector<Coded> made = codedAt(**encoder, {24, 24, 51, 20, 20});
    ASSERT_EQ(areIdr(made), (std::vector<bool>{true, false, false, false, false}));
    EXPECT_LT(made[2].psnr_db, made[1].psnr_db - 3);
    EXPECT_GT(made[4].psnr_db, made[2].psnr_db + 3);
    EXPECT_GT(made[3].size_bytes, 2 * made[2].size_bytes);
  }
}

TEST(OpenH264, refusesAQuantisationThatIsNotSafe) {
  const auto encoder = OpenH264Encoder::make({.size_px = {64, 48}, .qp = 24});
  EXPECT_EQ((*encoder)->setQp(kVideoQpMin - 1).code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ((*encoder)->setQp(kVideoQpMax + 1).code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ((*encoder)->format().qp, 24u);
  const auto threaded = OpenH264Encoder::make({.size_px = {64, 48},
                                               .qp = 24,
                                               .thread_count = 2,
                                               .entropy = EntropyCoding::kVariableLength});
  EXPECT_EQ((*threaded)->setQp(kThreadedQpMin - 1).code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ((*threaded)->format().qp, 24u);
}

std::unique_ptr<VideoEncoder> plannedEncoder(EncoderPlan plan) {
  const auto choice =
      VideoEncoderChoice::choose({plannedKind("planned", std::move(plan)), openH264Kind()}, "auto");
  EXPECT_TRUE(choice.ok()) << choice.status();
  EXPECT_THAT((*choice)->text(), testing::StartsWith("planned"));
  auto encoder = (*choice)->make({.size_px = kSize_px, .qp = 30});
  EXPECT_TRUE(encoder.ok()) << encoder.status();
  return *std::move(encoder);
}

TEST(FallbackEncoder, goesOnInTheMiddleOfAChain) {
  const auto encoder = plannedEncoder(failingFrom(8));
  EXPECT_EQ(
      areIdr(codedAt(*encoder, {30, 24, 24, 40, 40, 40, 24, 24, 30, 24})),
      (std::vector<bool>{true, false, false, false, false, false, false, false, true, false}));
}

TEST(FallbackEncoder, beginsAnewWhereTheQuantisationCannotBeSet) {
  EncoderPlan plan;
  plan.before_qp = [](uint32_t qp) {
    return qp == 40 ? absl::InternalError("the device is lost") : absl::OkStatus();
  };
  const auto encoder = plannedEncoder(plan);
  EXPECT_EQ(areIdr(codedAt(*encoder, {30, 24, 40, 40, 30})),
            (std::vector<bool>{true, false, true, false, false}));
}

TEST(FallbackEncoder, keepsItsEncoderWhereTheQuantisationIsRefused) {
  const auto encoder = plannedEncoder({});
  EXPECT_EQ(encoder->setQp(kVideoQpMin - 1).code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(areIdr(codedAt(*encoder, {30, 24})), (std::vector<bool>{true, false}));
}

}  // namespace
}  // namespace viewloom::test::quantisation_test
