// SPDX-License-Identifier: Apache-2.0
#include "lib/preferred_video.h"

#include <gtest/gtest.h>

namespace viewloom::test::preferred_video_test {
namespace {

TEST(PreferredVideo, comesFirstFromAnotherMachine) {
  for (const char* server : {"192.0.2.7:50051", "https://render.example:443"}) {
    v1::OpenDisplay open;
    open.mutable_display()->set_preset("portrait");
    preferVideo(server, open);
    ASSERT_EQ(open.accepted_size(), 2) << server;
    EXPECT_EQ(open.accepted(0).color(), v1::BAND_ENCODING_H264);
    EXPECT_EQ(open.accepted(1).color(), v1::BAND_ENCODING_UNSPECIFIED);
  }
}

TEST(PreferredVideo, isNotForThisMachine) {
  for (const char* server : {"127.0.0.1:50051", "[::1]:50051", "unix:/run/viewloom.sock"}) {
    v1::OpenDisplay open;
    preferVideo(server, open);
    EXPECT_EQ(open.accepted_size(), 0) << server;
  }
}

TEST(PreferredVideo, isNotForTrackedEyes) {
  v1::OpenDisplay open;
  open.mutable_display()->mutable_stereo()->set_tracked(true);
  preferVideo("192.0.2.7:50051", open);
  EXPECT_EQ(open.accepted_size(), 0);
}

}  // namespace
}  // namespace viewloom::test::preferred_video_test
