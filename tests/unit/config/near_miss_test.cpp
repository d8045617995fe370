// SPDX-License-Identifier: Apache-2.0
#include "config/near_miss.h"

#include <gtest/gtest.h>

namespace viewloom {
namespace {

const std::vector<std::string> kKeys{"device", "grpc.address", "limits.frame_bytes_max",
                                     "limits.streams_max"};

TEST(NearMiss, findsTheKeyBehindASlipOfThePen) {
  EXPECT_EQ(nearMiss("devise", kKeys), "device");
  EXPECT_EQ(nearMiss("grpc.adress", kKeys), "grpc.address");
  EXPECT_EQ(nearMiss("limits.frame_byte_max", kKeys), "limits.frame_bytes_max");
  EXPECT_EQ(nearMiss("limit.stream_max", kKeys), "limits.streams_max");
}

TEST(NearMiss, findsAKeyOfWhichTheSectionIsMissing) {
  EXPECT_EQ(nearMiss("frame_bytes_max", kKeys), "limits.frame_bytes_max");
}

TEST(NearMiss, staysSilentAboutOtherWords) {
  EXPECT_EQ(nearMiss("colour", kKeys), "");
  EXPECT_EQ(nearMiss("", kKeys), "");
}

}  // namespace
}  // namespace viewloom
