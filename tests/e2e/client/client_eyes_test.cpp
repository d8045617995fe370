// SPDX-License-Identifier: Apache-2.0
// `viewloom watch --eyes` against a real viewloomd.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "e2e/client/with_viewloomd.h"

namespace viewloom::client_eyes_test {
namespace {

namespace fs = std::filesystem;
using test::runCommand;
using test::smallFrame;
using ::testing::HasSubstr;

class ClientEyes : public test::WithViewloomd {
 protected:
  void SetUp() override {
    tracked_ = folder_ / "tracked.json";
    std::ofstream(tracked_) << R"({"stereo": {"eyeSize": {"width": 48, "height": 32},)"
                            << R"( "tracked": true}})";
    eyes_ = folder_ / "eyes.jsonl";
    // A head that goes to the right for 20 s.
    std::ofstream lines(eyes_);
    for (int i = 1; i <= 2000; ++i) {
      const double x_m = 0.001 * i;
      lines << "{\"time_ns\": " << i << "0000000, \"left\": [" << x_m << ", 0, 0], \"right\": ["
            << x_m + 0.06 << ", 0, 0]}\n";
    }
  }

  std::string command(const fs::path& display) const {
    return std::string(VIEWLOOM) + " --server " + address_ + " watch s -q --display " +
           display.string();
  }

  static std::string bytesOf(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  fs::path tracked_;
  fs::path eyes_;
};

TEST_F(ClientEyes, movesTheViewsOfAFrameThatStands) {
  const auto publisher = publish();
  publisher->offer(smallFrame(0));
  for (const std::string& source : {eyes_.string(), "- < " + eyes_.string()}) {
    const fs::path out = folder_ / "out";
    ASSERT_EQ(runCommand(command(tracked_) + " --count 3 --format png --out " + out.string() +
                         " --eyes " + source),
              0);
    std::set<std::string> pictures;  // of the first atlas, whichever it is, and two later ones
    for (const fs::directory_entry& file : fs::directory_iterator(out)) {
      pictures.insert(bytesOf(file.path()));
    }
    EXPECT_EQ(pictures.size(), 3U);
    EXPECT_GT(pictures.begin()->size(), 100U);
    fs::remove_all(out);
  }
}

TEST_F(ClientEyes, refusesWhatIsNoEye) {
  const auto publisher = publish();
  publisher->offer(smallFrame(0));
  const fs::path fixed = folder_ / "fixed.json";
  std::ofstream(fixed) << R"({"stereo": {"eyeSize": {"width": 48, "height": 32}}})";
  EXPECT_EQ(runCommand(command(fixed) + " --eyes " + eyes_.string() + " 2>/dev/null"), 2);
  EXPECT_EQ(runCommand(command(tracked_) + " --eyes /nowhere 2>/dev/null"), 2);
  const fs::path errors = folder_ / "errors";
  const auto problemOf = [&](const std::string& line) {
    std::ofstream(folder_ / "line") << line;
    EXPECT_EQ(runCommand(command(tracked_) + " --eyes - < " + (folder_ / "line").string() + " 2> " +
                         errors.string()),
              1);
    return bytesOf(errors);
  };
  EXPECT_THAT(problemOf("left"),
              HasSubstr("the eyes of the standard input, line 1: is not a JSON object"));
  EXPECT_THAT(problemOf(R"({"time_ns": 1, "left": [0, 0, -1e6], "right": [0, 0, 0]})"),
              HasSubstr("eye_poses.eyes[0].pose.position.z: the eye is at z = -1e+06 m"));
}

}  // namespace
}  // namespace viewloom::client_eyes_test
