// SPDX-License-Identifier: Apache-2.0
// Views as H.264 from a whole server, beside the same views without loss.
#include <gtest/gtest.h>

#include "e2e/atlas_viewer.h"
#include "e2e/picture_psnr.h"
#include "e2e/service_fixture.h"
#include "e2e/wire_displays.h"
#include "video/annex_b.h"
#include "video/h264_parameters.h"
#include "video/video_encoder.h"

namespace viewloom::test::service_video_test {
namespace {

AtlasPicture planeOf(const Atlas& atlas, v1::AtlasPlane plane) {
  auto picture = decodePlane(atlas, plane);
  EXPECT_TRUE(picture.ok()) << picture.status();
  return picture.ok() ? *std::move(picture) : AtlasPicture{};
}

double lumaDb(const Atlas& a, const Atlas& b) {
  return lumaPsnrDb(planeOf(a, v1::ATLAS_PLANE_COLOR), planeOf(b, v1::ATLAS_PLANE_COLOR));
}

class ServiceVideoTest : public ServiceFixture {
 protected:
  void SetUp() override {
    ServiceFixture::SetUp();
    if (!IsSkipped()) publishOnce(2);
  }
};

constexpr uint32_t kFineQp = kVideoQpMin;

TEST_F(ServiceVideoTest, showsTheSameViewsInTheSameLayout) {
  v1::OpenDisplay grid = openScene();
  cameraGrid(grid);
  v1::OpenDisplay stereo = openScene();
  eyes(stereo).set_layout(v1::STEREO_LAYOUT_SEPARATE);
  v1::OpenDisplay one = openScene();
  cameraList(one);
  for (const v1::OpenDisplay& open : {smallQuilt(), grid, stereo, one}) {
    const Atlas exact = atlasOf(open);
    const Atlas video = atlasOf(asVideo(open, kFineQp));
    EXPECT_GT(lumaDb(video, exact), kFineLumaDb) << open.ShortDebugString();
    v1::AtlasLayout layout = *video.layout;
    layout.clear_video();
    *layout.mutable_encoding() = exact.layout->encoding();
    EXPECT_EQ(layout.SerializeAsString(), exact.layout->SerializeAsString());
  }
}

TEST_F(ServiceVideoTest, showsWalkedViewsAsSweptOnes) {
  v1::OpenDisplay swept = smallQuilt();
  v1::OpenDisplay walked = swept;
  v1::Pose& pose = *walked.mutable_display()->mutable_world_pose();
  pose.mutable_orientation()->set_z(5e-4);
  pose.mutable_orientation()->set_w(1);
  for (const v1::OpenDisplay& open : {swept, walked}) {
    const Atlas video = atlasOf(asVideo(open, kFineQp));
    EXPECT_GT(lumaDb(video, atlasOf(open)), kFineLumaDb) << video.header.method();
  }
}

TEST_F(ServiceVideoTest, keepsDepthAndMaskExact) {
  v1::OpenDisplay open = smallQuilt();
  open.mutable_encoding()->set_with_depth(true);
  open.mutable_encoding()->set_with_mask(true);
  const Atlas exact = atlasOf(open);
  const Atlas video = atlasOf(asVideo(open, 24));
  for (const v1::AtlasPlane plane : {v1::ATLAS_PLANE_DEPTH, v1::ATLAS_PLANE_MASK}) {
    EXPECT_EQ(planeOf(video, plane).samples, planeOf(exact, plane).samples) << plane;
  }
}

TEST_F(ServiceVideoTest, sendsOnePictureABandAsTheLayoutSays) {
  const Atlas atlas = atlasOf(asVideo(smallQuilt(), 0));
  const v1::VideoStack& stack = atlas.layout->video();
  EXPECT_EQ(atlas.layout->encoding().video_qp(), 24u) << "matched to quality 85";
  EXPECT_TRUE(atlas.header.discardable());
  EXPECT_EQ(atlas.header.reference_sequence(), 0u);
  EXPECT_EQ(atlas.header.video_qp(), 24u);
  ASSERT_EQ(atlas.bands.size(), stack.picture_count());
  for (uint32_t picture = 0; picture < stack.picture_count(); ++picture) {
    const AtlasBand& band = atlas.bands[picture];
    EXPECT_EQ(band.image_index, picture);
    EXPECT_EQ(band.row_count, stack.picture_size().height());
    const auto* const data = reinterpret_cast<const uint8_t*>(band.bytes.data());
    const std::vector<NalUnit> units = nalUnits({data, band.bytes.size()});
    ASSERT_FALSE(units.empty());
    EXPECT_EQ(units.back().type(), picture == 0 ? NalType::kIdrSlice : NalType::kSlice);
    if (picture > 0) continue;
    const auto parameters = h264ParametersOf({data, band.bytes.size()});
    ASSERT_TRUE(parameters.ok()) << parameters.status();
    EXPECT_EQ(h264CodecString(*parameters), stack.codec_string());
    EXPECT_EQ(parameters->size_px,
              (SizePx{stack.picture_size().width(), stack.picture_size().height()}));
  }
}

TEST_F(ServiceVideoTest, codesAnAtlasOnceForAllItsViewers) {
  v1::OpenDisplay open = asVideo(smallQuilt(), 24);
  open.set_count(0);
  AtlasViewer first(service_->grpcAddress(), open);
  const Atlas atlas = first.waitFor([](const Atlas&) { return true; });
  const double coded_count = service_->metrics().video_pictures.value();
  EXPECT_EQ(coded_count, atlas.layout->video().picture_count());
  AtlasViewer second(service_->grpcAddress(), open);
  const Atlas same = second.waitFor([](const Atlas&) { return true; });
  ASSERT_EQ(same.bands.size(), atlas.bands.size());
  for (size_t i = 0; i < atlas.bands.size(); ++i) {
    EXPECT_EQ(same.bands[i].bytes, atlas.bands[i].bytes);
  }
  EXPECT_EQ(service_->metrics().video_pictures.value(), coded_count);
}

TEST_F(ServiceVideoTest, servesTheFirstEncodingThatAClientAccepts) {
  v1::OpenDisplay open = smallQuilt();
  open.clear_encoding();
  open.add_accepted()->set_color(v1::BAND_ENCODING_H264);
  open.add_accepted()->set_color(v1::BAND_ENCODING_JPEG);
  EXPECT_EQ(atlasOf(open).layout->encoding().color(), v1::BAND_ENCODING_H264);
  microlenses(open);
  EXPECT_EQ(atlasOf(open).layout->encoding().color(), v1::BAND_ENCODING_JPEG);
}

}  // namespace
}  // namespace viewloom::test::service_video_test
