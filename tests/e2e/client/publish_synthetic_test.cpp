// SPDX-License-Identifier: Apache-2.0
// viewloom publish --synthetic as a command line: what its scenes carry when they arrive.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "e2e/client/with_viewloomd.h"
#include "e2e/reflected_share.h"

namespace viewloom::publish_synthetic_test {
namespace {

using test::reflectedShare;

// It publishes until enough has been seen of it, and ends by itself should that never be.
constexpr const char* kLongest_s = "120";

class PublishSynthetic : public test::WithViewloomd {
 protected:
  // Publishes with these flags, and returns the atlases of a small quilt.
  std::vector<Atlas> published(const std::string& flags, uint32_t atlas_count) {
    v1::OpenDisplay open = test::smallQuilt(atlas_count);
    open.mutable_encoding()->set_color(v1::BAND_ENCODING_RAW);
    open.mutable_display()->mutable_effects()->mutable_reflection()->set_bounces(1);
    std::vector<Atlas> atlases;
    const auto watcher = watch(open, [&](const Atlas& atlas) { atlases.push_back(atlas); });
    // Killed by its id once the last atlas has come: a polite end waits for the server.
    const std::string command = std::string(VIEWLOOM) + " --server " + address_ +
                                " publish -q --stream s --synthetic --size 160x90 --fps 20 " +
                                "--seconds " + kLongest_s + " " + flags;
    const std::string pid_file = (folder_ / "pid").string();
    EXPECT_EQ(test::runCommand(command + " & echo $! >" + pid_file), 0);
    EXPECT_TRUE(watcher->waitEnded(test::kLong_ns));
    EXPECT_EQ(test::runCommand("kill -KILL $(cat " + pid_file + ")"), 0);
    EXPECT_EQ(atlases.size(), atlas_count);
    return atlases;
  }
};

TEST_F(PublishSynthetic, mirrorsWhereItIsToldTo) {
  const std::vector<Atlas> mirrors = published("--mirrors", 1);
  ASSERT_FALSE(mirrors.empty());
  // Shares of the rays that mirrors sent on: of none where nothing mirrors.
  EXPECT_NEAR(reflectedShare(mirrors.back().end), 1, 1e-6);
  EXPECT_GT(mirrors.back().end.reflections().hit(), 0);
}

TEST_F(PublishSynthetic, mirrorsAndMovesNothingByItself) {
  const std::vector<Atlas> plain = published("", 3);
  ASSERT_EQ(plain.size(), 3U);
  for (const Atlas& atlas : plain) {
    EXPECT_EQ(reflectedShare(atlas.end), 0);
    const v1::Pose& pose = atlas.header.source_camera().pose();
    EXPECT_EQ(pose.position().x(), 0);
    EXPECT_EQ(pose.position().y(), 0);
    EXPECT_EQ(pose.position().z(), 0);
  }
}

TEST_F(PublishSynthetic, movesItsCameraWhereItIsToldTo) {
  // The camera sways along x at 0.31 Hz by 0.3 m: in 50 ms by up to 29 mm.
  constexpr double kSway_m = 0.3;
  const std::vector<Atlas> atlases = published("--moving-camera", 4);
  ASSERT_EQ(atlases.size(), 4U);
  for (size_t i = 1; i < atlases.size(); ++i) {
    const v1::Pose& before = atlases[i - 1].header.source_camera().pose();
    const v1::Pose& pose = atlases[i].header.source_camera().pose();
    EXPECT_GT(atlases[i].header.frame_number(), atlases[i - 1].header.frame_number());
    EXPECT_NE(pose.position().x(), before.position().x());
    EXPECT_NE(pose.orientation().y(), before.orientation().y());
    EXPECT_LE(std::abs(pose.position().x()), kSway_m);
  }
}

}  // namespace
}  // namespace viewloom::publish_synthetic_test
