// SPDX-License-Identifier: Apache-2.0
// render, bench and doctor as processes, on pictures made here.
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <nlohmann/json.hpp>

#include "e2e/render_folder.h"
#include "files/png_image.h"
#include "support/loopback.h"

namespace viewloom::test::commands_test {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

TEST_F(RenderTest, returnsTheSourceFromItsOwnPlaceAndScoresByTheGivenMask) {
  std::vector<uint8_t> covered(kWidth * kHeight, 255);
  std::fill_n(covered.begin(), kWidth * 8, uint8_t{0});
  std::fill_n(covered.begin() + kWidth * 8, kWidth * 8, uint8_t{128});
  writePng("covered.png", covered, 1);
  const std::string prefix = folder_.string() + "/";
  const FinishedRun run =
      render("frame.json", "display.json",
             "--compare " + prefix + "truth.json --covered-mask " + prefix + "covered.png");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const Json report = Json::parse(run.output);
  const Json& view = report.at("views").at(0);
  // Exact, also before it is rounded to the picture's 8 bits.
  const auto source = files::readPngColor(folder_ / "color.png", false);
  const auto rendered = files::readPngColor(folder_ / "out" / "view_000.png", false);
  ASSERT_TRUE(source.ok() && rendered.ok());
  EXPECT_EQ(source->bytes, rendered->bytes);
  EXPECT_EQ(view.at("by_renderer").at("all").at("psnr_db"), "inf");
  EXPECT_EQ(view.at("by_renderer").at("covered").at("share"), 1);
  EXPECT_TRUE(view.at("by_renderer").at("hidden").at("psnr_db").is_null());
  EXPECT_LT(view.at("by_renderer").at("covered").at("flip").get<double>(), 0.01);
  EXPECT_TRUE(view.at("by_renderer").at("hidden").at("flip").is_null());
  EXPECT_EQ(view.at("by_mask").at("covered").at("share"), 0.5);
  EXPECT_EQ(view.at("by_mask").at("hidden").at("share"), 0.25);
  EXPECT_EQ(view.at("by_mask").at("outside").at("share"), 0.25);
  EXPECT_GT(report.at("coverage").at("hidden").get<double>(), 0) << "the view to the right";
  for (const Json& name : report.at("files")) {
    EXPECT_GT(fs::file_size(folder_ / "out" / name.get<std::string>()), 0u);
  }
  EXPECT_EQ(report.at("files").size(), 5u);
}

// The darkest and the lightest codes included, which no transfer may turn into something else.
TEST_F(RenderTest, scoresItselfUnderEveryTransfer) {
  for (const char* transfer : {"srgb", "gamma2.2"}) {
    const FinishedRun run =
        render("frame.json", "display.json",
               "--compare " + folder_.string() + "/truth.json --transfer " + transfer);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const Json score = Json::parse(run.output).at("views").at(0).at("by_renderer").at("all");
    EXPECT_EQ(score.at("psnr_db"), "inf") << transfer;
  }
}

// Looking back, nothing of the source is in view: opaque and semitransparent sources alike.
TEST_F(RenderTest, whatIsOutsideTakesTheBackground) {
  constexpr std::array<uint8_t, 3> kBackground{0xff, 0x80, 0x01};
  std::vector<uint8_t> background;
  std::vector<uint8_t> glass;
  for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
    background.insert(background.end(), kBackground.begin(), kBackground.end());
    glass.insert(glass.end(), {10, 200, 30, 128});
  }
  writePng("background.png", background, 3);
  writePng("glass.png", glass, 4);
  write("truth.json", R"({"views":[{"viewIndex":0,"color":{"file":"background.png"}}]})");
  write("back.json",
        R"({"outsideFill":"OUTSIDE_FILL_BACKGROUND","backgroundRgb":16744449,"cameras":{)"
        R"("columns":1,"tileSize":{"width":48,"height":32},"cameras":[)"
        R"({"pose":{"orientation":{"y":1}},"intrinsics":)" +
            kIntrinsics + "}]}}");
  for (const char* color : {"color.png", "glass.png"}) {
    write("frame.json", frameJson(color));
    const FinishedRun run =
        render("frame.json", "back.json", "--compare " + folder_.string() + "/truth.json");
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const auto rendered = files::readPngColor(folder_ / "out" / "view_000.png", false);
    ASSERT_TRUE(rendered.ok()) << rendered.status();
    EXPECT_EQ(rendered->bytes, background) << color;
    const Json score = Json::parse(run.output).at("views").at(0).at("by_renderer").at("outside");
    EXPECT_EQ(score.at("share"), 1) << color;
    // Before rounding, too.
    const Json& psnr_db = score.at("psnr_db");
    EXPECT_TRUE(psnr_db == "inf" || psnr_db.get<double>() > 20 * std::log10(510)) << color;
  }
}

TEST_F(RenderTest, refusesBadInputByFileAndField) {
  write("zero.json", R"({"quilt":{"columns":0,"rows":1,"size":{"width":8,"height":8}}})");
  write("unknown.json", R"({"quilt":{"colums":4}})");
  struct Case {
    std::string frame;
    std::string display;
    std::string expected;
  };
  for (const Case& bad : {Case{"missing.json", "display.json", "missing.json"},
                          Case{"frame.json", "zero.json", "zero.json.quilt.columns"},
                          Case{"frame.json", "unknown.json", "colums"}}) {
    const FinishedRun run = render(bad.frame, bad.display, "");
    EXPECT_EQ(run.exit_code, 1) << bad.expected;
    EXPECT_THAT(run.errors, HasSubstr(bad.expected));
    EXPECT_EQ(run.output, "");
  }
}

TEST_F(RenderTest, opensADisplayByTheNameOfItsDevice) {
  const std::string files =
      strCat("render --frame ", folder_.string(), "/frame.json --out ", folder_.string(), "/out");
  const FinishedRun run = runViewloom(files + " --preset near_eye_2013");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_GT(Json::parse(run.output).at("coverage").at("hit"), 0.5);
  const FinishedRun mistyped = runViewloom(files + " --preset near_eye_2031");
  EXPECT_EQ(mistyped.exit_code, 1);
  EXPECT_THAT(mistyped.errors,
              AllOf(HasSubstr("viewloom render: --preset: there is no preset \"near_eye_2031\""),
                    HasSubstr("did you mean \"near_eye_2013\"?")));
  EXPECT_EQ(runViewloom(files).exit_code, 2) << "no display at all";
}

// Files of half a kilobyte stand for a disk that is full.
TEST_F(RenderTest, leavesNoHalfOfAPictureWhereTheDiskIsFull) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{.rlim_cur = 512, .rlim_max = before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const FinishedRun run = render("frame.json", "display.json", "");
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(run.exit_code, 1) << run.errors;
  EXPECT_THAT(run.errors, HasSubstr("cannot be written: it reached the largest size allowed\n"));
  EXPECT_TRUE(fs::is_empty(folder_ / "out"));
}

TEST_F(RenderTest, printsNoControlCharactersOfNames) {
  const FinishedRun run = render("\x1b[31mred.json", "display.json", "");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.errors, HasSubstr("\\x1b[31mred.json: no such file"));
}

TEST_F(RenderTest, refusesATruthOfAnotherSizeAndABorderThatLeavesNothing) {
  write("beyond.json", R"({"views":[{"viewIndex":2,"color":{"file":"color.png"}}]})");
  const std::string prefix = " --compare " + folder_.string() + "/";
  const FinishedRun beyond = render("frame.json", "display.json", prefix + "beyond.json");
  EXPECT_EQ(beyond.exit_code, 1);
  EXPECT_THAT(beyond.errors, HasSubstr("views[0].view_index: got 2, accepted is 0..1"));
  const FinishedRun border =
      render("frame.json", "display.json", prefix + "truth.json --border 16");
  EXPECT_EQ(border.exit_code, 1);
  EXPECT_THAT(border.errors, HasSubstr("--border: got 16"));
}

TEST(Doctor, saysWhichPortIsTakenAndWhatToDo) {
  const int listener = listenAnywhere();
  const std::string taken = addressOf(listener);

  const FinishedRun run =
      runViewloomd("doctor --grpc.address " + taken + " --http.address 127.0.0.1:0");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.output, HasSubstr("grpc.address " + taken + " cannot be taken"));
  EXPECT_THAT(run.output, HasSubstr("choose another address with --grpc.address"));
  close(listener);
  const FinishedRun free =
      runViewloomd("doctor --grpc.address " + taken + " --http.address 127.0.0.1:0");
  EXPECT_EQ(free.exit_code, 0) << free.output;
  EXPECT_THAT(free.output, HasSubstr("a small scene was rendered"));
  EXPECT_THAT(free.output, HasSubstr("ok      video  openh264 (OpenH264 2."));
}

TEST(Doctor, namesADeviceThatDoesNotExist) {
  const FinishedRun run = runViewloomd("doctor --device no-such-device");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.output, HasSubstr("PROBLEM device"));
}

TEST(Bench, reportsEveryStageAsJson) {
  const FinishedRun run = runViewloom("bench --repeat 1 --seconds 0.5 --cone 2");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const Json report = Json::parse(run.output);
  for (const char* stage : {"upload", "build", "trace", "encode_one_thread"}) {
    EXPECT_GT(report.at("stages").at(stage).at("ms").get<double>(), 0) << stage;
  }
  EXPECT_EQ(report.at("stages").at("rays"), 3360 * 3360);
  // 540 / tan(18 deg) px of focal length; the outermost of 48 views, 47/48 of a degree aside of a
  // focus 4.16 m away; a ball 2.01 m away. The last two to a percent: they are read off the depth.
  const double span_px = report.at("scene").at("disparity_span_px");
  EXPECT_NEAR(span_px, 1662 * 4.16 * std::tan(47.0 / 48 * 0.0174533) / 2.01, 0.02 * span_px);
  const Json& structure = report.at("structure");
  EXPECT_GT(structure.at("stored_nodes_per_px").get<double>(), 1.0 / 16) << "4x4 nodes";
  EXPECT_GT(structure.at("effective_nodes_per_px").get<double>(), 1.0 / 4096) << "64x64 nodes";
  EXPECT_GE(report.at("visits_per_ray").at("mean").get<double>(), 1);
  EXPECT_GE(report.at("loopback").at("share_of_none_of_these").get<double>(), 0);
  EXPECT_GT(report.at("memory").at("process_peak_bytes").get<uint64_t>(), 0u);
}

}  // namespace
}  // namespace viewloom::test::commands_test
