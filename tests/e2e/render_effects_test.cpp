// SPDX-License-Identifier: Apache-2.0
// viewloom render with each effect of a display: what it changes, px by px, and what it leaves.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "e2e/render_folder.h"
#include "support/srgb_transfer.h"

namespace viewloom::test::render_effects_test {
namespace {

using Json = nlohmann::json;

constexpr double kFocal_px = 40;  // of the scene's camera
constexpr double kWall_m = 2;
constexpr double kSquare_m = 1;
constexpr uint32_t kRow = kSquareTop + kSquareSide / 2;
constexpr uint8_t kWhite = 255;
constexpr uint8_t kBlack = 0;
constexpr int kCodeTolerance = 1;  // what is looked up as binary16 and rounded once more

// A black square before a white wall.
class RenderEffectsTest : public RenderTest {
 protected:
  void SetUp() override {
    RenderTest::SetUp();
    writeSquareAndWall("plain.png", kBlack, kWhite);
    write("frame.json", frameJson("plain.png"));
  }

  void writeSquareAndWall(const std::string& name, uint8_t square, uint8_t wall) {
    std::vector<uint8_t> color;
    for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
      const bool is_square = isSquare(i % kWidth, i / kWidth, kSquareLeft);
      color.insert(color.end(), 3, is_square ? square : wall);
    }
    writePng(name, color, 3);
  }

  // From the camera's own place.
  Json renderWith(const std::string& effects, const std::string& frame = "frame.json") {
    write("effects.json", R"({"cameras":{"tileSize":{"width":48,"height":32},"cameras":[)" +
                              cameraJson(0) + R"(]},"effects":{)" + effects + "}}");
    const FinishedRun run = render(frame, "effects.json", "");
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    return Json::parse(run.output);
  }
};

// Share of a unit disc that lies beyond a chord at this distance from its centre.
double shareBeyond(double distance) {
  return (std::acos(distance) - distance * std::sqrt(1 - distance * distance)) / std::numbers::pi;
}

TEST_F(RenderEffectsTest, aLensBlursWhatIsOutOfFocusAlone) {
  constexpr double kAperture_m = 0.15;
  constexpr double kRadius_px = kAperture_m * kFocal_px * (1 / kSquare_m - 1 / kWall_m);
  // The lens has fewer than a hundred points, evenly spread.
  constexpr int kSamplingTolerance = 12;  // 8-bit codes
  renderWith("");
  const std::vector<uint8_t> sharp = picture();
  EXPECT_EQ(codeAt(sharp, kSquareLeft - 1, kRow), kWhite);
  renderWith(R"("lens":{"apertureRadiusM":)" + std::to_string(kAperture_m) +
             R"(,"focusDistanceM":)" + std::to_string(kWall_m) + "}");
  const std::vector<uint8_t> blurred = picture();
  for (uint32_t away_px = 1; away_px < kRadius_px; ++away_px) {
    const double light = 1 - shareBeyond((away_px - 0.5) / kRadius_px);
    EXPECT_NEAR(codeAt(blurred, kSquareLeft - away_px, kRow), 255 * srgbFrom(light),
                kSamplingTolerance)
        << away_px;
  }
  for (uint32_t x = 0; x + kRadius_px + 1 < kSquareLeft; ++x) {
    EXPECT_NEAR(codeAt(blurred, x, kRow), kWhite, kCodeTolerance) << "in focus, px " << x;
  }
  EXPECT_NEAR(codeAt(blurred, kSquareLeft + kSquareSide / 2, kRow), kBlack, kCodeTolerance);
}

// Seen from the front, a mirror shows what is behind the camera: nothing, so the environment.
TEST_F(RenderEffectsTest, whatMirrorsShowsTheEnvironmentWhereADisplayAsksForIt) {
  constexpr std::array<uint8_t, 3> kEnvironment{0x40, 0x80, 0xC0};
  constexpr uint32_t kEnvironmentRgb = 0x4080C0;
  writeSquareAndWall("black.png", kBlack, kBlack);
  writeSquareAndWall("specular.png", kBlack, kWhite);
  const std::string layer =
      layerJson("black.png", "depth.pfm") + R"(,"specular":{"file":"specular.png"})";
  write("mirror.json", strCat("{", sourcesJson(0, layer), "}"));
  EXPECT_FALSE(renderWith("", "mirror.json").contains("reflections"));
  EXPECT_EQ(codeAt(picture(), kSquareLeft / 2, kRow), kBlack);
  const std::string effect =
      R"("reflection":{"bounces":1,"environmentRgb":)" + std::to_string(kEnvironmentRgb) + "}";
  const Json report = renderWith(effect, "mirror.json");
  EXPECT_GT(report.at("reflections").at("environment").get<double>(), 0.9);
  const std::vector<uint8_t> mirrored = picture();
  for (uint32_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(codeAt(mirrored, kSquareLeft / 2, kRow, c), kEnvironment[c], kCodeTolerance) << c;
    EXPECT_EQ(codeAt(mirrored, kSquareLeft + kSquareSide / 2, kRow, c), kBlack) << "no mirror";
  }
  EXPECT_FALSE(renderWith(effect).contains("reflections")) << "of a frame without mirrors";
}

// The wall is in the plane without parallax, the square before it.
TEST_F(RenderEffectsTest, aStereoDisplayMovesWhatIsNearApart) {
  constexpr double kEyeDistance_m = 0.4;
  constexpr auto kShift_px =
      uint32_t(0.5 * kEyeDistance_m * kFocal_px * (1 / kSquare_m - 1 / kWall_m));
  write("stereo.json", R"({"stereo":{"eyeSize":{"width":48,"height":32},"eyeDistanceM":)" +
                           std::to_string(kEyeDistance_m) + R"(,"focalDistanceM":)" +
                           std::to_string(kWall_m) + "}}");
  const FinishedRun run = render("frame.json", "stereo.json", "");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  for (const uint32_t eye : {0U, 1U}) {
    SCOPED_TRACE(eye);
    const std::vector<uint8_t> seen = picture(eye);
    const uint32_t left = eye == 0 ? kSquareLeft + kShift_px : kSquareLeft - kShift_px;
    for (uint32_t x = left + 1; x + 1 < left + kSquareSide; ++x) {
      EXPECT_NEAR(codeAt(seen, x, kRow), kBlack, kCodeTolerance) << x;
    }
    // On the side where the eye sees nothing that the source does not.
    const uint32_t beside = eye == 0 ? left + kSquareSide + 1 : left - 2;
    EXPECT_NEAR(codeAt(seen, beside, kRow), kWhite, kCodeTolerance);
  }
}

}  // namespace
}  // namespace viewloom::test::render_effects_test
