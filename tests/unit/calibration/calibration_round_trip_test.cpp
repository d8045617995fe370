// SPDX-License-Identifier: Apache-2.0
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "calibration/calibration.h"
#include "unit/calibration/device_files.h"

namespace viewloom::calibration_round_trip_test {
namespace {

void expectComesBack(const Calibration& calibration) {
  const std::string file = writeCalibration(calibration);
  const absl::StatusOr<Calibration> read = parseCalibration(file);
  ASSERT_TRUE(read.ok()) << read.status() << file;
  EXPECT_EQ(*read, calibration) << file;
}

TEST(WrittenCalibration, isReadAsItWas) {
  expectComesBack(*parseCalibration(kPortraitFile));
  expectComesBack(*parseCalibration(kThirdGenerationFile));
}

TEST(WrittenCalibration, keepsEveryBitOfRandomNumbers) {
  constexpr unsigned kSeed = 4711;
  std::mt19937_64 random(kSeed);
  const auto in = [&](double min, double max) {
    return std::uniform_real_distribution<double>(min, max)(random);
  };
  const auto coin = [&] { return (random() & 1) != 0; };
  const auto offset = [&] { return SubpixelOffset{in(-16, 16), in(-16, 16)}; };
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", file " << i);
    Calibration calibration{
        .pitch = in(20, 90),
        .slope = in(-9, 9),
        .center = in(-1, 1),
        .view_cone_deg = in(10, 80),
        .vertical_angle = in(-1, 1),
        .dpi = in(100, 500),
        .screen_px = {static_cast<uint32_t>(in(1, 16384)), static_cast<uint32_t>(in(1, 16384))},
        .inv_view = coin(),
        .flip_x = coin(),
        .flip_y = coin(),
        .flip_subpixels = coin(),
        .cell_pattern_mode = static_cast<uint32_t>(random() % 5),
        .serial = "LKG-\"\\\xc3\xa4/" + std::to_string(i),
        .config_version = "3.0",
    };
    for (size_t cell = random() % 5; cell > 0; --cell) {
      calibration.cells.push_back({offset(), offset(), offset()});
    }
    expectComesBack(calibration);
  }
}

TEST(WrittenCalibration, wrapsNumbersAsDevicesDo) {
  const nlohmann::json file =
      nlohmann::json::parse(writeCalibration(*parseCalibration(kThirdGenerationFile)));
  EXPECT_EQ(file["pitch"]["value"], 44.75058319896644);
  EXPECT_EQ(file["CellPatternMode"]["value"], 2.0);
  EXPECT_EQ(file["subpixelCells"][1]["BOffsetY"], 0.25);
  EXPECT_EQ(file["serial"], "LKG-J00332");
}

}  // namespace
}  // namespace viewloom::calibration_round_trip_test
