// SPDX-License-Identifier: Apache-2.0
// render, bench and doctor as processes, on pictures made here.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "e2e/run_viewloomd.h"
#include "files/file_bytes.h"
#include "files/png_image.h"
#include "files/png_writer.h"

namespace viewloom::test {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr uint32_t kWidth = 48;
constexpr uint32_t kHeight = 32;

// A noisy wall at 2 m with a noisy square at 1 m before it, and a display that sees it from the
// source's own place and from 0.1 m to the right.
class RenderTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_);
    std::vector<uint8_t> color;
    std::vector<float> depth_m;  // PFM: bottom row first
    for (uint32_t i = 0; i < kWidth * kHeight * 3; ++i)
      color.push_back(uint8_t(i * i * 7 + i * 31));
    for (uint32_t y = 0; y < kHeight; ++y) {
      for (uint32_t x = 0; x < kWidth; ++x) {
        const bool is_square = x >= 16 && x < 28 && y >= 10 && y < 22;
        depth_m.push_back(is_square ? 1 : 2);
      }
    }
    writePng("color.png", color, 3);
    std::ofstream pfm(folder_ / "depth.pfm", std::ios::binary);
    pfm << "Pf\n" << kWidth << " " << kHeight << "\n-1\n";
    pfm.write(reinterpret_cast<const char*>(depth_m.data()),
              std::streamsize(depth_m.size() * sizeof(float)));
    write("frame.json",
          R"({"sources":[{"camera":{"intrinsics":)" + kIntrinsics +
              R"(},"layers":[{)"
              R"("color":{"file":"color.png"},)"
              R"("depth":{"file":"depth.pfm","depth":{"meaning":"DEPTH_MEANING_PLANAR"}}}]}]})");
    write("display.json",
          R"({"cameras":{"columns":2,"tileSize":{"width":48,"height":32},"cameras":[)"
          R"({"intrinsics":)" +
              kIntrinsics +
              R"(},)"
              R"({"pose":{"position":{"x":0.1}},"intrinsics":)" +
              kIntrinsics + "}]}}");
    write("truth.json", R"({"views":[{"viewIndex":0,"color":{"file":"color.png"}}]})");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }
  void writePng(const std::string& name, const std::vector<uint8_t>& samples, uint32_t channels) {
    const auto png = files::encodePng(samples, kWidth, kHeight, channels);
    ASSERT_TRUE(png.ok()) << png.status();
    ASSERT_TRUE(files::writeFileWhole(folder_ / name, *png).ok());
  }
  FinishedRun render(const std::string& frame, const std::string& display,
                     const std::string& flags) {
    const std::string prefix = folder_.string() + "/";
    return runViewloomd("render --frame " + prefix + frame + " --display " + prefix + display +
                        " --out " + prefix + "out " + flags);
  }

  const std::string kIntrinsics =
      R"({"focalXPx":40,"focalYPx":40,"principalXPx":24,"principalYPx":16})";
  const fs::path folder_ =
      fs::temp_directory_path() / ("viewloom_render_" + std::to_string(getpid()));
};

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
  // Exact in the picture's 8 bits; before rounding, less than half a level off in the mean.
  const auto source = files::readPngColor(folder_ / "color.png", false);
  const auto rendered = files::readPngColor(folder_ / "out" / "view_000.png", false);
  ASSERT_TRUE(source.ok() && rendered.ok());
  EXPECT_EQ(source->bytes, rendered->bytes);
  EXPECT_GT(view.at("by_renderer").at("all").at("psnr_db").get<double>(), 20 * std::log10(510));
  EXPECT_EQ(view.at("by_renderer").at("covered").at("share"), 1);
  EXPECT_TRUE(view.at("by_renderer").at("hidden").at("psnr_db").is_null());
  EXPECT_EQ(view.at("by_mask").at("covered").at("share"), 0.5);
  EXPECT_EQ(view.at("by_mask").at("hidden").at("share"), 0.25);
  EXPECT_EQ(view.at("by_mask").at("outside").at("share"), 0.25);
  EXPECT_GT(report.at("coverage").at("hidden").get<double>(), 0) << "the view to the right";
  for (const Json& name : report.at("files")) {
    EXPECT_GT(fs::file_size(folder_ / "out" / name.get<std::string>()), 0u);
  }
  EXPECT_EQ(report.at("files").size(), 5u);
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
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(listener, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(listen(listener, 1), 0);
  ASSERT_EQ(getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size), 0);
  const std::string taken = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));

  const FinishedRun run =
      runViewloomd("doctor --grpc.address " + taken + " --http.address 127.0.0.1:0");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.output, HasSubstr("grpc.address " + taken + " cannot be taken"));
  EXPECT_THAT(run.output, HasSubstr("choose another address with --grpc.address"));
  close(listener);
  const FinishedRun free =
      runViewloomd("doctor --grpc.address " + taken + " --http.address 127.0.0.1:0");
  EXPECT_EQ(free.exit_code, 0) << free.output;
  EXPECT_THAT(free.output, HasSubstr("a small scene was built and traced"));
}

TEST(Doctor, namesADeviceThatDoesNotExist) {
  const FinishedRun run = runViewloomd("doctor --device no-such-device");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.output, HasSubstr("PROBLEM device"));
}

TEST(Bench, reportsEveryStageAsJson) {
  const FinishedRun run = runViewloomd("bench --repeat 1 --seconds 0.5 --cone 2");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const Json report = Json::parse(run.output);
  for (const char* stage : {"upload", "build", "trace", "encode_one_thread"}) {
    EXPECT_GT(report.at("stages").at(stage).at("ms").get<double>(), 0) << stage;
  }
  EXPECT_EQ(report.at("stages").at("rays"), 3360 * 3360);
  // 540 / tan(18 deg) px of focal length, an eye 1 deg aside of a focus 2..4 m away, and a ball at
  // 1.1..1.7 m in front.
  const double span_px = report.at("scene").at("disparity_span_px");
  EXPECT_GT(span_px, 1662 * 2 * std::tan(0.01745) / 1.7);
  EXPECT_LT(span_px, 1662 * 4 * std::tan(0.01746) / 1.1);
  const Json& structure = report.at("structure");
  EXPECT_GT(structure.at("stored_nodes_per_px").get<double>(), 1.0 / 16) << "4x4 nodes";
  EXPECT_GT(structure.at("effective_nodes_per_px").get<double>(), 1.0 / 4096) << "64x64 nodes";
  EXPECT_GE(report.at("visits_per_ray").at("mean").get<double>(), 1);
  EXPECT_GE(report.at("loopback").at("share_of_none_of_these").get<double>(), 0);
  EXPECT_GT(report.at("memory").at("process_peak_bytes").get<uint64_t>(), 0u);
}

}  // namespace
}  // namespace viewloom::test
