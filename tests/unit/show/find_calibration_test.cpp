// SPDX-License-Identifier: Apache-2.0
#include "show/find_calibration.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::show::find_calibration_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A file system of its own below a root, gone with the test.
class FindCalibration : public testing::Test {
 protected:
  FindCalibration() : root_(fs::path(testing::TempDir()) / uniqueName()) { fs::remove_all(root_); }
  ~FindCalibration() override { fs::remove_all(root_); }

  static std::string uniqueName() {
    return std::string("viewloom_") + testing::UnitTest::GetInstance()->current_test_info()->name();
  }

  fs::path plugIn(const fs::path& mount, const std::string& text) {
    const fs::path folder = root_ / mount / "LKG_calibration";
    fs::create_directories(folder);
    std::ofstream(folder / "visual.json") << text;
    return folder / "visual.json";
  }

  const std::string good_ = writeCalibration(
      {.pitch = 52.5, .slope = -7.2, .dpi = 324, .screen_px = {1536, 2048}, .serial = "LKG-P1"});
  const fs::path root_;
};

TEST_F(FindCalibration, looksWhereStorageIsMounted) {
  EXPECT_THAT(findCalibrationFiles(root_), IsEmpty());
  const fs::path by_user = plugIn("media/ann/LKG", good_);
  const fs::path by_hand = plugIn("mnt/usb", good_);
  const fs::path by_label = plugIn("media/LKG2", good_);
  const fs::path by_udisks = plugIn("run/media/ann/LKG", good_);
  plugIn("home/ann", good_);
  plugIn("mnt/disk/deep", good_);
  EXPECT_THAT(findCalibrationFiles(root_), ElementsAre(by_label, by_user, by_hand, by_udisks));
}

TEST_F(FindCalibration, takesTheOneThatIsPluggedIn) {
  plugIn("media/ann/LKG", good_);
  const auto chosen = chooseCalibration("", root_);
  ASSERT_TRUE(chosen.ok() && chosen->has_value()) << chosen.status();
  EXPECT_EQ((*chosen)->serial, "LKG-P1");
}

TEST_F(FindCalibration, isWithoutOneWhereNothingIsPluggedIn) {
  const auto chosen = chooseCalibration("", root_);
  ASSERT_TRUE(chosen.ok()) << chosen.status();
  EXPECT_FALSE(chosen->has_value());
}

TEST_F(FindCalibration, asksWhichOfSeveralIsMeant) {
  const fs::path one = plugIn("media/ann/LKG", good_);
  const fs::path two = plugIn("mnt/usb", good_);
  const absl::Status several = chooseCalibration("", root_).status();
  EXPECT_EQ(several.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(several.message()),
              HasSubstr(one.string() + ", " + two.string() + "; name one with --calibration"));
  EXPECT_TRUE(chooseCalibration(two.string(), root_).ok());
}

TEST_F(FindCalibration, namesTheFileAndTheKeyThatAreWrong) {
  const fs::path file = plugIn("mnt/usb", R"({"pitch":52})");
  const absl::Status broken = chooseCalibration("", root_).status();
  EXPECT_THAT(std::string(broken.message()), HasSubstr(file.string() + ": slope: is missing"));
  const fs::path large = plugIn("mnt/usb", std::string(70000, ' '));
  EXPECT_THAT(std::string(chooseCalibration("", root_).status().message()),
              HasSubstr("has 70000 bytes; accepted are up to 65536"));
}

TEST(DevicePreset, isTheSerialNumbersElseThePanelSizes) {
  EXPECT_EQ(presetOf({.screen_px = {1536, 2048}, .serial = "LKG-F0001"}), "kiosk");
  EXPECT_EQ(presetOf({.screen_px = {3840, 2160}, .serial = "LKG-J00332"}), "16_gen3_l");
  EXPECT_EQ(presetOf({.screen_px = {2560, 1600}, .serial = "00297"}), "8_9_gen1");
  EXPECT_EQ(presetOf({.screen_px = {1440, 2560}}), "go_p");
  EXPECT_EQ(presetOf({.screen_px = {123, 45}}), "portrait");
}

}  // namespace
}  // namespace viewloom::show::find_calibration_test
