// SPDX-License-Identifier: Apache-2.0
// Every kind of display of a whole server, as a client decodes it.
#include <gtest/gtest.h>

#include <cmath>

#include "e2e/picture_psnr.h"
#include "e2e/service_fixture.h"
#include "e2e/wire_displays.h"
#include "lib/catalog.h"
#include "lib/channel.h"

namespace viewloom::test::service_displays_test {
namespace {

class ServiceDisplaysTest : public ServiceFixture {
 protected:
  void SetUp() override {
    ServiceFixture::SetUp();
    if (!IsSkipped()) publishOnce(2);
  }

  static AtlasPicture colorOf(const Atlas& atlas) {
    auto picture = decodePlane(atlas, v1::ATLAS_PLANE_COLOR);
    EXPECT_TRUE(picture.ok()) << picture.status();
    return *std::move(picture);
  }
};

TEST_F(ServiceDisplaysTest, saysWhetherItTracesThemOnACpu) {
  const auto info = Catalog(makeChannel(service_->grpcAddress())).getServerInfo();
  ASSERT_TRUE(info.ok()) << info.status();
  // Lavapipe's name for itself.
  EXPECT_EQ(info->traces_on_cpu(), info->device().find("llvmpipe") != std::string::npos)
      << info->device();
}

TEST_F(ServiceDisplaysTest, sendsEachViewAsAnImageOfItsOwn) {
  v1::OpenDisplay together = openScene();
  cameraGrid(together);
  v1::OpenDisplay apart = openScene();
  cameraGrid(apart).set_arrangement(v1::TILE_ARRANGEMENT_SEPARATE_VIEWS);
  const Atlas atlas = atlasOf(together);
  const Atlas images = atlasOf(apart);
  EXPECT_EQ(atlas.layout->columns(), 3u);
  ASSERT_EQ(images.layout->image_count(), 6u);
  ASSERT_EQ(images.layout->view_count(), 6u);
  for (uint32_t view = 0; view < 6; ++view) {
    EXPECT_EQ(cutView(colorOf(images), *images.layout, view).samples,
              cutView(colorOf(atlas), *atlas.layout, view).samples)
        << view;
  }
  apart.mutable_encoding()->set_color(v1::BAND_ENCODING_JPEG);
  apart.mutable_encoding()->set_chroma(v1::CHROMA_SUBSAMPLING_444);
  apart.mutable_encoding()->set_jpeg_quality(95);
  const Atlas jpegs = atlasOf(apart);
  EXPECT_GT(psnrDb(colorOf(jpegs), colorOf(images)), 30);
  for (uint32_t view = 0; view < 6; ++view) {
    EXPECT_TRUE(joinJpegBands(jpegs, v1::ATLAS_PLANE_COLOR, view).ok()) << view;
  }
}

TEST_F(ServiceDisplaysTest, sendsTheEyesAsTwoImages) {
  v1::OpenDisplay together = openScene();
  eyes(together).set_layout(v1::STEREO_LAYOUT_TOP_BOTTOM);
  v1::OpenDisplay apart = openScene();
  eyes(apart).set_layout(v1::STEREO_LAYOUT_SEPARATE);
  const Atlas images = atlasOf(apart);
  EXPECT_EQ(images.layout->image_count(), 2u);
  EXPECT_EQ(colorOf(images).samples, colorOf(atlasOf(together)).samples);
}

TEST_F(ServiceDisplaysTest, sendsPanelsAsOneImagePerChannelUnlessAskedOtherwise) {
  v1::OpenDisplay raw = openScene();
  panel(raw);
  v1::OpenDisplay usual = raw;
  usual.clear_encoding();
  const AtlasPicture exact = colorOf(atlasOf(raw));
  EXPECT_EQ(exact.width_px, 201u);
  EXPECT_EQ(exact.height_px, 130u);
  const Atlas planes = atlasOf(usual);
  EXPECT_EQ(planes.layout->encoding().color(), v1::BAND_ENCODING_JPEG_PLANES);
  for (const v1::AtlasPlane plane :
       {v1::ATLAS_PLANE_RED, v1::ATLAS_PLANE_GREEN, v1::ATLAS_PLANE_BLUE}) {
    EXPECT_TRUE(joinJpegBands(planes, plane).ok()) << plane;
  }
  const double planes_db = psnrDb(colorOf(planes), exact);
  v1::OpenDisplay shared = raw;
  shared.mutable_encoding()->set_color(v1::BAND_ENCODING_JPEG);
  const double shared_db = psnrDb(colorOf(atlasOf(shared)), exact);
  std::cout << "planes: " << planes_db << " dB, one 4:4:4 JPEG: " << shared_db << " dB\n";
  EXPECT_GT(planes_db, shared_db);
}

TEST_F(ServiceDisplaysTest, averagesSamplesOfSweptAndWalkedViewsAlike) {
  v1::OpenDisplay quilt = openScene();
  *quilt.mutable_display() = openQuilt("scene", {240, 120}).display();
  quilt.mutable_display()->mutable_filter()->set_sample_count(4);
  const Atlas swept = atlasOf(quilt);
  // A display turned by a twentieth of a degree cannot be swept. It looks the same.
  v1::Pose& pose = *quilt.mutable_display()->mutable_world_pose();
  pose.mutable_orientation()->set_z(5e-4);
  pose.mutable_orientation()->set_w(1);
  const Atlas walked = atlasOf(quilt);
  EXPECT_EQ(swept.header.method(), v1::TRACE_METHOD_SWEEP);
  EXPECT_EQ(walked.header.method(), v1::TRACE_METHOD_WALK);
  EXPECT_GT(psnrDb(colorOf(swept), colorOf(walked)), 30);
  EXPECT_GT(swept.end.coverage().hit(), 0.5);
}

TEST_F(ServiceDisplaysTest, servesMicrolensPanels) {
  v1::OpenDisplay open = openScene();
  microlenses(open);
  const Atlas atlas = atlasOf(open);
  EXPECT_EQ(atlas.header.method(), v1::TRACE_METHOD_WALK);
  const AtlasPicture picture = colorOf(atlas);
  // Three lenses of 83 1/3 px stand in the middle of 320 px: the columns beside them are black.
  EXPECT_EQ(picture.samples[3 * (90 * 320 + 10)], 0);
  EXPECT_NE(picture.samples[3 * (90 * 320 + 160) + 2], 0);
}

}  // namespace
}  // namespace viewloom::test::service_displays_test
