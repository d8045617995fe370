// SPDX-License-Identifier: Apache-2.0
// The client, the command and the Python example against a real viewloomd.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <future>
#include <mutex>
#include <sstream>
#include <string>
#include <vector>

#include "e2e/client/with_viewloomd.h"
#include "files/jpeg_image.h"
#include "lib/catalog.h"
#include "lib/channel.h"
#include "lib/publisher.h"
#include "lib/watcher.h"
#include "support/deep_exr_writer.h"
#include "synthetic/synthetic_wire_frame.h"

namespace viewloom::client_viewloomd_test {
namespace {

namespace fs = std::filesystem;
using test::kLong_ns;
using test::runCommand;
using test::smallFrame;
using ClientWithViewloomd = test::WithViewloomd;

TEST_F(ClientWithViewloomd, publishesAFrameAndWatchesItsQuilt) {
  std::vector<Atlas> atlases;
  const auto watcher = watch(1, [&](const Atlas& atlas) { atlases.push_back(atlas); });
  const auto publisher = publish();
  publisher->offer(smallFrame(0));
  ASSERT_TRUE(watcher->waitEnded(kLong_ns));
  EXPECT_EQ(*watcher->ended(), absl::OkStatus());
  EXPECT_EQ(publisher->finish(kLong_ns), absl::OkStatus());
  ASSERT_EQ(atlases.size(), 1U);
  EXPECT_EQ(atlases[0].layout->view_count(), 4U);
  const auto color = decodePlane(atlases[0], v1::ATLAS_PLANE_COLOR);
  ASSERT_TRUE(color.ok()) << color.status();
  EXPECT_EQ(color->width_px, 96U);
  const auto mask = decodePlane(atlases[0], v1::ATLAS_PLANE_MASK);
  ASSERT_TRUE(mask.ok()) << mask.status();
  const auto hits = std::count(mask->samples.begin(), mask->samples.end(), v1::RAY_CLASS_HIT);
  EXPECT_GT(hits, static_cast<std::ptrdiff_t>(mask->samples.size() / 2));
  EXPECT_EQ(stop(), 0);
}

TEST_F(ClientWithViewloomd, publishesACubeMapAndWatchesItsQuilt) {
  std::vector<Atlas> atlases;
  const auto watcher = watch(1, [&](const Atlas& atlas) { atlases.push_back(atlas); });
  const auto publisher = publish();
  WireFrame frame;
  addSyntheticCubeMap({.size_px = {64, 36}, .layer_count = 2, .camera = {}}, frame);
  publisher->offer(std::move(frame));
  ASSERT_TRUE(watcher->waitEnded(kLong_ns));
  EXPECT_EQ(*watcher->ended(), absl::OkStatus());
  ASSERT_EQ(atlases.size(), 1U);
  const auto mask = decodePlane(atlases[0], v1::ATLAS_PLANE_MASK);
  ASSERT_TRUE(mask.ok()) << mask.status();
  const auto hits = std::count(mask->samples.begin(), mask->samples.end(), v1::RAY_CLASS_HIT);
  EXPECT_GT(hits, static_cast<std::ptrdiff_t>(mask->samples.size() / 2));
}

TEST_F(ClientWithViewloomd, servesWhoCameBackAfterARestart) {
  std::promise<void> seen_before, seen_after;
  int seen = 0;
  const auto watcher = watch(2, [&](const Atlas&) {
    if (++seen == 1) seen_before.set_value();
  });
  const auto publisher = publish();
  publisher->offer(smallFrame(0));
  ASSERT_EQ(seen_before.get_future().wait_for(std::chrono::nanoseconds(kLong_ns)),
            std::future_status::ready);
  EXPECT_EQ(stop(), 0);
  start();
  // Nothing is offered again: the publisher shows its still, the watcher gets the second atlas of
  // it.
  ASSERT_TRUE(watcher->waitEnded(kLong_ns))
      << "publisher: " << publisher->ended().value_or(absl::OkStatus()) << ", sent "
      << publisher->counts().sent << ", watcher has " << watcher->counts().atlases.whole;
  EXPECT_EQ(*watcher->ended(), absl::OkStatus());
  EXPECT_EQ(watcher->counts().reconnects, 1U);
  EXPECT_EQ(publisher->counts().reconnects, 1U);
}

TEST_F(ClientWithViewloomd, tellsItsPresetsAndLimits) {
  const Catalog catalog(makeChannel(address_));
  const auto presets = catalog.listPresets();
  ASSERT_TRUE(presets.ok()) << presets.status();
  EXPECT_GT(presets->presets_size(), 5);
  const auto info = catalog.getServerInfo();
  ASSERT_TRUE(info.ok()) << info.status();
  EXPECT_EQ(info->ingest_limits().layer_count_max(), 4U);
}

TEST_F(ClientWithViewloomd, theCommandPublishesAndWritesAQuilt) {
  const auto publisher = publish();
  publisher->offer(smallFrame(0));
  const std::string command = std::string(VIEWLOOM) + " --server " + address_;
  const fs::path out = folder_ / "out";
  EXPECT_EQ(runCommand(command + " watch s --count 1 --columns 2 --rows 2 --size 96x64 -q --out " +
                       out.string()),
            0);
  const fs::path quilt = out / "s_000001_000001_qs2x2a1.5.jpg";
  const auto image = files::readJpegColor(quilt);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->encoding, v1::PLANE_ENCODING_JPEG) << "baseline";
  EXPECT_EQ(image->width_px, 96U);
  EXPECT_EQ(runCommand(command +
                       " watch s --count 1 --columns 2 --rows 2 --size 96x64 -q --views"
                       " --format png --out " +
                       out.string()),
            0);
  EXPECT_EQ(std::distance(fs::directory_iterator(out), fs::directory_iterator()), 1 + 4);
  EXPECT_EQ(runCommand(command + " watch s --count 1 -q --focus-follow 0.5"), 0);
  EXPECT_NE(runCommand(command + " watch s --count 1 -q --focus-follow 99 2>/dev/null"), 0);
  EXPECT_EQ(runCommand(command + " list --json streams >/dev/null"), 0);
  EXPECT_EQ(runCommand(command + " publish --synthetic --size 64x36 --seconds 0.2 -q --stream t"),
            0);
  EXPECT_EQ(runCommand(command + " publish --synthetic --sources 2 --size 64x36 --seconds 0.2 -q"
                                 " --stream two"),
            0);
  EXPECT_EQ(runCommand(command + " publish --synthetic --cube --size 64x36 --seconds 0.2 -q"
                                 " --stream cube"),
            0);
}

// The sky of the scene lies beyond what the source sees, from the outermost eyes.
TEST_F(ClientWithViewloomd, tellsPublisherAndWatcherOfViewsThatLookPastTheSource) {
  std::vector<v1::AtlasHeader> headers;
  const auto watcher = watch(4, [&](const Atlas& atlas) { headers.push_back(atlas.header); });
  std::mutex mutex;
  std::vector<v1::Wanted> wanted;
  const auto publisher = publish({.on_wanted = [&](const v1::Wanted& message) {
    std::lock_guard lock(mutex);
    wanted.push_back(message);
  }});
  for (int frame = 0; !watcher->waitEnded(100'000'000); ++frame) {
    publisher->offer(smallFrame(0.2 * frame));
  }
  ASSERT_EQ(*watcher->ended(), absl::OkStatus());
  EXPECT_EQ(publisher->finish(kLong_ns), absl::OkStatus());
  ASSERT_EQ(headers.size(), 4U);
  for (const v1::AtlasHeader& header : headers) {
    ASSERT_EQ(header.views_outside_size(), 2) << "at either end of the cone";
    EXPECT_EQ(header.views_outside(0).first_view(), 0U);
    EXPECT_EQ(header.views_outside(1).last_view(), 3U);
    EXPECT_NEAR(header.views_outside(0).share(), header.views_outside(1).share(), 1e-9);
  }
  std::lock_guard lock(mutex);
  const auto told = std::find_if(wanted.begin(), wanted.end(), [](const v1::Wanted& message) {
    return message.outside_size() > 0;
  });
  ASSERT_NE(told, wanted.end());
  const double share = told->outside(0).views(0).share();
  EXPECT_GE(share, headers[0].views_outside(0).share());
  EXPECT_LT(share, headers[0].views_outside(0).share() + 0.0101);
  EXPECT_LE(wanted.size(), 4U) << "only what changes is sent: displays come and go";
}

TEST_F(ClientWithViewloomd, theCommandAdvisesASource) {
  const std::string command = std::string(VIEWLOOM) + " --server " + address_ + " advise ";
  const std::string out = (folder_ / "advice").string();
  const auto text = [&] {
    std::ostringstream read;
    read << std::ifstream(out).rdbuf();
    return read.str();
  };
  // Two eyes at D tan(10 degrees) of a focal plane 2 m away, framed 2 tan(15 degrees) high.
  const std::string pair =
      "--columns 2 --rows 1 --size 200x100 --cone 40 --fov 30 "
      "--focal-distance 2 --near 2 --far 2 ";
  ASSERT_EQ(runCommand(command + pair + ">" + out), 0);
  EXPECT_THAT(text(), testing::HasSubstr("at 0 0 0 m"));
  EXPECT_THAT(text(), testing::HasSubstr("30.00 x 30.00 degrees"));
  EXPECT_THAT(text(), testing::HasSubstr("layers         2"));
  ASSERT_EQ(runCommand(command + pair + "--json >" + out), 0);
  EXPECT_THAT(text(), testing::HasSubstr("\"layerCount\": 2"));
  ASSERT_EQ(runCommand(command + "--preset portrait --fov 14 --near 0.3 --far 1000 >" + out), 0);
  EXPECT_THAT(text(), testing::HasSubstr("second source"));
  EXPECT_EQ(runCommand(command + "--preset portrait --near 1 --far 2 2>" + out), 2);
  EXPECT_THAT(text(), testing::HasSubstr("--fov is missing"));
  EXPECT_EQ(runCommand(command + "--fov 14 --near 3 --far 2 2>" + out), 1);
  EXPECT_THAT(text(), testing::HasSubstr("--far: got 2"));
}

TEST_F(ClientWithViewloomd, theCommandPublishesTestPatterns) {
  const std::string command = std::string(VIEWLOOM) + " --server " + address_ + " publish -q ";
  for (const std::string name : {"view-numbers", "parallax-ruler", "focal-grid", "card"}) {
    EXPECT_EQ(runCommand(command + "--pattern " + name + " --size 640x360 --views 12 --cone 30" +
                         " --seconds 0.1 --stream " + name),
              0)
        << name;
  }
  for (const std::string refused :
       {"--pattern rainbow", "--pattern view-numbers --views 500", "--pattern card --layers 2",
        "--pattern card --synthetic", "--pattern card --size 64x64", "--views 12 --synthetic"}) {
    EXPECT_NE(runCommand(command + refused + " --seconds 0.1 2>/dev/null"), 0) << refused;
  }
}

TEST_F(ClientWithViewloomd, theCommandWritesThePxOfAPanelWithoutMixingThem) {
  const auto publisher = publish();
  publisher->offer(smallFrame(0));
  const fs::path calibration = folder_ / "visual.json";
  std::ofstream(calibration) << R"({"pitch": 40, "slope": -6.5, "center": 0.3, "DPI": 320,)"
                             << R"( "screenW": 70, "screenH": 50})";
  const std::string watch = std::string(VIEWLOOM) + " --server " + address_ +
                            " watch s --count 1 -q --calibration " + calibration.string();
  for (const std::string encoding : {"", "--lossless"}) {
    const fs::path out = folder_ / ("panel" + encoding);
    EXPECT_EQ(runCommand(watch + " " + encoding + " --out " + out.string()), 0) << encoding;
    EXPECT_TRUE(fs::exists(out / "s_000001_000001.png")) << encoding;
  }
  std::ofstream(calibration) << R"({"pitch": 0})";
  EXPECT_EQ(runCommand(watch + " 2>/dev/null"), 1) << "the server refuses a panel without lenses";
}

TEST_F(ClientWithViewloomd, theCommandPublishesRealFiles) {
  const fs::path data = VIEWLOOM_SHARED_DATA;
  if (!fs::exists(data)) GTEST_SKIP() << data << " is not there";
  const std::string command = std::string(VIEWLOOM) + " --server " + address_ + " publish -q ";
  const std::string ball = (data / "beachball-stereo").string();
  const std::string antinous = (data / "hci-antinous").string();
  EXPECT_EQ(runCommand(command + ball +
                       "/singlepart.0001.exr --view right --depth-far-zero "
                       "--focal-px 2048 --stream ball"),
            0);
  // Its data window leaves the display window.
  EXPECT_EQ(runCommand(command + ball +
                       "/singlepart.0008.exr --view left --depth-far-zero "
                       "--focal-px 2048 --stream ball8"),
            0);
  EXPECT_EQ(runCommand(command + antinous + "/input_Cam040.png --depth " + antinous +
                       "/gt_disp_lowres.pfm --depth-meaning disparity --scale 0.025 "
                       "--depth-offset 0.125 --focal-px 1462.857 --stream antinous"),
            0);
  const auto streams = Catalog(makeChannel(address_)).listStreams();
  ASSERT_TRUE(streams.ok()) << streams.status();
  ASSERT_EQ(streams->streams_size(), 3);
  const v1::StreamEntry& of_antinous = streams->streams(0);
  const v1::StreamEntry& of_ball = streams->streams(1);
  EXPECT_EQ(of_ball.size().width(), 2048U);
  EXPECT_EQ(of_ball.size().height(), 1556U);
  EXPECT_EQ(of_ball.frame_number(), 1U);
  EXPECT_EQ(of_ball.stats().bad_samples_count(), 0U);
  // 1/m. Facets reach half a pixel beyond their samples; 3e-4 at the steepest of these two.
  constexpr double kFacetReach = 1e-3;
  // Z is 9.0..10.92 on the ball, far around it; the disparity -3.131..2.689 px (see SOURCE.txt).
  EXPECT_NEAR(of_ball.stats().inv_z_max(), 1 / 9.0, kFacetReach);
  EXPECT_NEAR(of_antinous.stats().inv_z_min(), 0.125 - 0.025 * 3.131, kFacetReach);
  EXPECT_NEAR(of_antinous.stats().inv_z_max(), 0.125 + 0.025 * 2.689, kFacetReach);
}

TEST_F(ClientWithViewloomd, theCommandSplitsADeepFileAndSaysWhatItCost) {
  const auto surface = [](float z_m, float alpha) {
    return deep::DeepSample{.z_m = z_m, .z_back_m = z_m, .alpha = alpha, .color = glm::vec3(alpha)};
  };
  test::DeepPicture picture;
  picture.data = picture.display = {{0, 0}, {31, 15}};
  picture.pixels.assign(32 * 16, {surface(2, 1)});
  for (size_t i = 0; i < 128; ++i) picture.pixels[i].push_back(surface(1, 0.5F));
  test::writeDeepExr(folder_ / "deep.exr", picture, {});
  const std::string errors = (folder_ / "errors").string();
  const std::string command = std::string(VIEWLOOM) + " --server " + address_ + " publish -q " +
                              "--stream deep --deep " + (folder_ / "deep.exr").string();
  EXPECT_EQ(runCommand(command + " --layers 1 2> " + errors), 0);
  const std::string said = (std::stringstream() << std::ifstream(errors).rdbuf()).str();
  EXPECT_THAT(said, testing::HasSubstr("deep.exr: up to 2 samples per pixel, split into 1 layer; "
                                       "25.00 % of pixels merged, occlusion error mean 0.0625, "
                                       "max 0.25 (1/m)\n"));
  const auto streams = Catalog(makeChannel(address_)).listStreams();
  ASSERT_TRUE(streams.ok()) << streams.status();
  ASSERT_EQ(streams->streams_size(), 1);
  EXPECT_EQ(streams->streams(0).size().width(), 32U);
  EXPECT_EQ(streams->streams(0).layer_count(), 1U);
  EXPECT_EQ(runCommand(command + " --alpha straight 2> " + errors), 2);
  EXPECT_EQ(runCommand(command + " --depth-meaning window 2> " + errors), 2);
  EXPECT_EQ(runCommand(command + " --synthetic 2> " + errors), 2);
}

TEST_F(ClientWithViewloomd, thePythonExampleSavesAQuiltAndAView) {
  const auto publisher = publish();
  publisher->offer(smallFrame(0));
  const std::string out = (folder_ / "python").string();
  ASSERT_EQ(runCommand(std::string("PYTHONPATH=") + VIEWLOOM_PYTHON + " /usr/bin/python3 " +
                       VIEWLOOM_EXAMPLE + " --stream s --preset portrait --server " + address_ +
                       " --out " + out),
            0);
  EXPECT_TRUE(fs::exists(out + "_view00.png"));
}

}  // namespace
}  // namespace viewloom::client_viewloomd_test
