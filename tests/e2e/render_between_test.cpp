// SPDX-License-Identifier: Apache-2.0
// viewloom render at times between frames and after them, for displays with an output rate.
#include <algorithm>
#include <cstdlib>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "e2e/render_folder.h"

namespace viewloom::test::render_between_test {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

// Frames are 0.1 s apart. In that time a camera moves by 0.1 m, or the square by 0.2 m (8 px).
constexpr uint32_t kStep_px = 8;
constexpr float kSquareSpeed_mps = 2;
// The middle row of the square. Its edges are blended, so rows at its ends are not tested.
constexpr uint32_t kRow = kSquareTop + kSquareSide / 2;
// Two pictures of one surface are blended as 11-bit codes, then rounded once more.
constexpr int kCodeTolerance = 1;

class RenderBetweenTest : public RenderTest {
 protected:
  void SetUp() override {
    RenderTest::SetUp();
    for (const char* mode : {"PREDICT", "INTERPOLATE"}) {
      write(std::string(mode) + ".json",
            R"({"cameras":{"tileSize":{"width":48,"height":32},"cameras":[)" + cameraJson(0) +
                R"(]},"effects":{"temporal":{"outputRateHz":60,"mode":"TEMPORAL_MODE_)" + mode +
                R"("}}})");
    }
    const std::string layer = layerJson("color.png", "depth.pfm");
    write("before.json", strCat("{", sourcesJson(-0.1, layer), "}"));
    write("newest.json", R"({"captureTimeNs":"100000000",)" + sourcesJson(0, layer) + "}");
  }

  FinishedRun renderLater(const std::string& mode, double later_s, const std::string& flags = "") {
    return render("newest.json", mode + ".json",
                  "--later " + std::to_string(later_s) + " " + flags);
  }
  std::string before(const std::string& file = "before.json") const {
    return "--before " + (folder_ / file).string();
  }

  // The pattern moves with the square; the wall keeps its own. Both are smooth, so that pixels at
  // their edges are recognisable, and each pixel differs from its neighbours.
  static uint8_t codeOf(uint32_t x, uint32_t y, uint32_t channel, uint32_t left) {
    return uint8_t(isSquare(x, y, left) ? 240 - 8 * (x - left) - 10 * channel
                                        : 20 + 3 * x + 10 * channel);
  }
  // A frame whose square begins at `left` and moves to the right.
  void writeMoving(const std::string& name, uint32_t left, const std::string& capture_time_ns) {
    std::vector<uint8_t> color;
    std::vector<float> motion_mps;
    for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
      for (uint32_t c = 0; c < 3; ++c) color.push_back(codeOf(i % kWidth, i / kWidth, c, left));
      const bool is_square = isSquare(i % kWidth, i / kWidth, left);
      motion_mps.insert(motion_mps.end(), {is_square ? kSquareSpeed_mps : 0, 0, 0});
    }
    writePng(name + ".png", color, 3);
    writePfm(name + "_motion.pfm", motion_mps, 3);
    writeDepth(name + "_depth.pfm", left);
    const std::string layer = layerJson(name + ".png", name + "_depth.pfm");
    write(name + ".json",
          R"({"captureTimeNs":")" + capture_time_ns + R"(",)" +
              sourcesJson(0, layer + R"(,"motion":{"file":")" + name + R"(_motion.pfm"})") + "}");
  }
  // Expects the scene whose square begins at `left`, in pixels [first, end) of the row.
  void expectRow(uint32_t left, uint32_t first, uint32_t end) const {
    const std::vector<uint8_t> got = picture();
    for (uint32_t x = first; x < end; ++x) {
      for (uint32_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(codeAt(got, x, kRow, c), codeOf(x, kRow, c, left), kCodeTolerance)
            << "px " << x << ", channel " << c;
      }
    }
  }
};

TEST_F(RenderBetweenTest, carriesTheCameraOnAsTheFrameBeforeTellsThatItMoves) {
  const FinishedRun run = renderLater("PREDICT", 0.1, before());
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(Json::parse(run.output).at("timing"), "predicted");
  const std::vector<uint8_t> predicted = picture();
  write("beside.json",
        R"({"cameras":{"tileSize":{"width":48,"height":32},"cameras":[)" + cameraJson(0.1) + "]}}");
  ASSERT_EQ(render("newest.json", "beside.json", "").exit_code, 0);
  EXPECT_EQ(predicted, picture());
  EXPECT_EQ(Json::parse(renderLater("PREDICT", 0.05).output).at("timing"), "captured")
      << "of one frame alone, nothing moves";
}

TEST_F(RenderBetweenTest, carriesOnWhatMovesByItself) {
  writeMoving("newest", kSquareLeft, "100000000");
  writeMoving("before", kSquareLeft - kStep_px, "0");
  const FinishedRun run = renderLater("PREDICT", 0.05, before());
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(Json::parse(run.output).at("timing"), "predicted");
  const uint32_t left = kSquareLeft + kStep_px / 2;
  expectRow(left, 0, kSquareLeft - 1);
  expectRow(left, left + 1, left + kSquareSide - 1);
  expectRow(left, left + kSquareSide + 1, kWidth);
}

TEST_F(RenderBetweenTest, seesFromBothFramesWhatLiesBetweenThem) {
  writeMoving("newest", kSquareLeft, "100000000");
  writeMoving("before", kSquareLeft - kStep_px, "0");
  const FinishedRun run = renderLater("INTERPOLATE", -0.05, before());
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(Json::parse(run.output).at("timing"), "interpolated");
  const uint32_t left = kSquareLeft - kStep_px / 2;
  const uint32_t right = left + kSquareSide;
  expectRow(left, left + 1, right - 1);
  // To either side one of them knows the wall that the other's square has uncovered by then.
  expectRow(left, 0, left - 1);
  expectRow(left, right + 1, kWidth);
}

TEST_F(RenderBetweenTest, seesTheFrameBeforeWhereThatStands) {
  writeMoving("newest", kSquareLeft, "100000000");
  writeMoving("before", kSquareLeft - kStep_px, "0");
  const FinishedRun run = renderLater("INTERPOLATE", -0.1, before());
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const uint32_t left = kSquareLeft - kStep_px;
  expectRow(left, 0, left - 1);
  expectRow(left, left + 1, left + kSquareSide - 1);
  expectRow(left, left + kSquareSide + 1, kWidth);
}

TEST_F(RenderBetweenTest, refusesTimesThatTheDisplayDoesNotShow) {
  EXPECT_THAT(render("newest.json", "display.json", "--later 0.1").errors,
              HasSubstr("effects.temporal: is missing, --later needs it"));
  EXPECT_THAT(renderLater("PREDICT", -0.05, before()).errors,
              HasSubstr("--later: got -0.05, accepted is 0 or more to predict"));
  EXPECT_THAT(renderLater("INTERPOLATE", -0.05).errors, HasSubstr("--before: is missing"));
  EXPECT_THAT(renderLater("INTERPOLATE", -0.2, before()).errors,
              HasSubstr("--later: got -0.2, accepted is -0.1..0"));
  for (const char* later : {"inf", "nan", "1e10"}) {
    EXPECT_THAT(render("newest.json", "PREDICT.json", std::string("--later ") + later).errors,
                HasSubstr("--later: got "))
        << later;
  }
  write("bright.json",
        strCat(R"({"exposureEv":1,)", sourcesJson(-0.1, layerJson("color.png", "depth.pfm")), "}"));
  EXPECT_THAT(renderLater("INTERPOLATE", -0.05, before("bright.json")).errors,
              HasSubstr("exposure_ev: got 0, accepted to interpolate is that of the frame before"));
  EXPECT_THAT(renderLater("PREDICT", 0.05, before("newest.json")).errors,
              HasSubstr("capture_time_ns: got 100000000, accepted is later than 100000000"));
  EXPECT_THAT(render("newest.json", "PREDICT.json", before()).errors, HasSubstr("--later"));
}

}  // namespace
}  // namespace viewloom::test::render_between_test
