// SPDX-License-Identifier: Apache-2.0
#include "base/nearest_name.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::nearest_name_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const std::vector<std::string> kKeys{"device", "grpc.address", "limits.frame_bytes_max",
                                     "limits.streams_max"};
const std::vector<std::string> kPresets{"go",           "portrait",     "portrait-16",
                                        "16-landscape", "32-landscape", "65"};

TEST(NearestName, findsTheKeyBehindASlipOfThePen) {
  EXPECT_EQ(nearestName("devise", kKeys), "device");
  EXPECT_EQ(nearestName("grpc.adress", kKeys), "grpc.address");
  EXPECT_EQ(nearestName("limits.frame_byte_max", kKeys), "limits.frame_bytes_max");
  EXPECT_EQ(nearestName("limit.stream_max", kKeys), "limits.streams_max");
}

TEST(NearestName, findsAKeyOfWhichTheSectionIsMissing) {
  EXPECT_EQ(nearestName("frame_bytes_max", kKeys), "limits.frame_bytes_max");
}

TEST(NearestName, countsTwoSwappedLettersAsOneSlip) {
  const std::vector<std::string> commands{"list", "cast", "show"};
  EXPECT_EQ(nearestName("lsit", commands), "list");
  EXPECT_EQ(nearestName("hsow", commands), "show");
}

TEST(NearestName, ignoresCase) {
  EXPECT_EQ(nearestName("PORTRAIT", kPresets), "portrait");
  EXPECT_EQ(nearestName("Potrait", kPresets), "portrait");
}

TEST(NearestName, completesABeginning) {
  EXPECT_THAT(nearestNames("port", kPresets), ElementsAre("portrait", "portrait-16"));
  EXPECT_THAT(nearestNames("po", kPresets), ElementsAre("go"));
}

TEST(NearestName, namesTheNearestFirstAndThreeAtMost) {
  EXPECT_THAT(nearestNames("36-landscape", kPresets), ElementsAre("16-landscape", "32-landscape"));
  const std::vector<std::string> alike{"cam5", "cam1", "cam2", "cam", "cam1"};
  EXPECT_THAT(nearestNames("cam", alike), ElementsAre("cam", "cam5", "cam1"));
}

TEST(NearestName, staysSilentAboutOtherWords) {
  EXPECT_EQ(nearestName("colour", kKeys), "");
  EXPECT_EQ(nearestName("", kKeys), "");
  EXPECT_THAT(nearestNames("portrait", {}), IsEmpty());
  EXPECT_EQ(didYouMean("colour", kKeys), "");
}

TEST(NearestName, asksWithTheNamesInQuotes) {
  EXPECT_EQ(didYouMean("devise", kKeys), "did you mean \"device\"?");
  EXPECT_EQ(didYouMean("36-landscape", kPresets),
            "did you mean \"16-landscape\" or \"32-landscape\"?");
}

TEST(NearestName, listsTheNamesThatThereAre) {
  const std::vector<std::string> names{"go", "portrait"};
  EXPECT_EQ(
      noSuchName("preset", "potrait", names),
      "there is no preset \"potrait\"; known presets: go, portrait; did you mean \"portrait\"?");
  EXPECT_EQ(noSuchName("stream", "x\033", {}),
            "there is no stream \"x\\x1b\"; there are no streams yet");
}

TEST(NearestName, listsNoMoreThanSomeOfManyNames) {
  const std::vector<std::string> many(1000, std::string(64, 'a'));
  const std::string text = noSuchName("stream", "x", many);
  EXPECT_TRUE(text.ends_with(" and 968 more")) << text;
  EXPECT_LT(text.size(), 32 * 70U);
}

TEST(NearestName, quotesTheBeginOfALongWord) {
  std::string word;
  while (word.size() < 1500) word += "光";
  const std::string text = noSuchName("preset", word, {});
  EXPECT_LT(text.size(), 200U);
  EXPECT_NE(text.find("光光...\""), std::string::npos) << text;
}

TEST(NearestName, isFastForALongWord) {
  EXPECT_EQ(didYouMean(std::string(size_t{1} << 20, 'x'), kPresets), "");
}

}  // namespace
}  // namespace viewloom::nearest_name_test
