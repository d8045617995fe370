// SPDX-License-Identifier: Apache-2.0
// Files that are written wrongly: what looks wrong in them, and that the remedy that is named makes
// the scene that was written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "cli/file_frames.h"
#include "unit/cli/wrong_files.h"

namespace viewloom::cli::remedies_test {
namespace {

using inspect::LayerInspection;
using test::isNothing;
using test::kInf;
using test::roomAt;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class RemediesTest : public test::WrongFilesTest {};

struct Wrong {
  const char* name;
  std::function<float(int x, int y)> z;
  const char* kind;
  const char* remedy;
};

TEST_F(RemediesTest, makeTheSceneOfWrongExrFiles) {
  const std::vector<Wrong> table{
      {"negative Z", [](int x, int y) { return -roomAt(x, y); }, "empty", "--depth-scale -1"},
      {"negative centimetres", [](int x, int y) { return -100 * roomAt(x, y); }, "empty",
       "--depth-scale -0.01"},
      {"negative millimetres", [](int x, int y) { return -1000 * roomAt(x, y); }, "empty",
       "--depth-scale -0.001"},
      {"1/Z", [](int x, int y) { return 1 / roomAt(x, y); }, "inside-out",
       "--depth-meaning disparity"},
      {"1/Z without some", [](int x, int y) { return isNothing(x, y) ? 0 : 1 / roomAt(x, y); },
       "inside-out", "--depth-meaning disparity"},
      {"centimetres", [](int x, int y) { return 100 * roomAt(x, y); }, "scale",
       "--depth-scale 0.01"},
      {"millimetres", [](int x, int y) { return 1000 * roomAt(x, y); }, "scale",
       "--depth-scale 0.001"},
      {"kilometres", [](int x, int y) { return 0.001F * roomAt(x, y); }, "scale",
       "--depth-scale 1000"},
      {"Arnold's nothing", [](int x, int y) { return isNothing(x, y) ? 1e30F : roomAt(x, y); },
       "nothing", "--depth-invalid 1e+30"},
      {"another's nothing", [](int x, int y) { return isNothing(x, y) ? 1e9F : roomAt(x, y); },
       "nothing", "--depth-invalid 1e+09"},
      {"filtered nothing",
       [](int x, int y) {
         return isNothing(x, y) ? (x == 71 ? 3e29F : 1e30F) * (1 + 0.001F * float(y))
                                : roomAt(x, y);
       },
       "nothing", "--no-surface-beyond 1e+06"},
      {"-inf", [](int x, int y) { return isNothing(x, y) ? -kInf : roomAt(x, y); }, "bad",
       "--depth-invalid=-inf --depth-invalid-is-far"},
  };
  for (const Wrong& wrong : table) {
    const FrameFiles files = exr(wrong.z);
    const LayerInspection layer = inspected(files);
    const std::string remedy = remedyOf(layer, wrong.kind);
    EXPECT_EQ(remedy, wrong.remedy) << wrong.name;
    if (remedy.find("--") == std::string::npos) continue;
    const LayerInspection mended = inspected(files, remedy);
    EXPECT_THAT(mended.suspicions, IsEmpty()) << wrong.name;
    EXPECT_LT(rangeError(mended, 1 / (0.25 + 0.025 * 20), 4), 1e-3) << wrong.name;
  }
}

TEST_F(RemediesTest, findNoneWhereNothingCanBeDone) {
  for (const float everywhere : {0.0F, kInf, std::numeric_limits<float>::quiet_NaN()}) {
    const LayerInspection layer = inspected(exr([everywhere](int, int) { return everywhere; }));
    EXPECT_EQ(remedyOf(layer, "empty"), "") << everywhere;
  }
}

TEST_F(RemediesTest, makeColourOpaque) {
  for (const float alpha : {0.0F, 0.004F}) {
    const FrameFiles files = exr(roomAt, alpha);
    EXPECT_EQ(remedyOf(inspected(files), "alpha"), "--alpha opaque") << alpha;
    EXPECT_THAT(inspected(files, "--alpha opaque").suspicions, IsEmpty()) << alpha;
  }
  EXPECT_THAT(inspected(exr(roomAt)).suspicions, IsEmpty());
}

TEST_F(RemediesTest, findTheUnitOfSensors) {
  const FrameFiles files =
      pair(16, [](int x, int y) { return isNothing(x, y) ? 0.0 : 1000.0 * double{roomAt(x, y)}; });
  EXPECT_EQ(remedyOf(inspected(files), "scale"), "--input sensor");
  EXPECT_THAT(inspected(files, "--input sensor").suspicions, IsEmpty());
}

// 1/Z spread over fewer codes than the file has room for.
TEST_F(RemediesTest, findTheCodeOfWhite) {
  const auto codes = [](double last) {
    return [last](int x, int y) {
      // One px alone is white.
      return x == 50 && y == 63 ? last : 0.99 * last * (1 / double{roomAt(x, y)} - 0.25) / 0.5;
    };
  };
  const FrameFiles photoshop = pair(16, codes(32768));
  EXPECT_EQ(remedyOf(inspected(photoshop), "bits"), "--input relative --depth-white 32768");
  EXPECT_EQ(remedyOf(inspected(photoshop, "--input relative"), "bits"), "--depth-white 32768");
  const LayerInspection mended = inspected(
      photoshop, "--input relative --depth-white 32768 --depth-near 1.3333 --depth-far 4");
  EXPECT_THAT(mended.suspicions, IsEmpty());
  EXPECT_LT(rangeError(mended, 1.3333, 4), 2e-3);
  EXPECT_EQ(remedyOf(inspected(pair(16, codes(4095)), "--input relative"), "bits"),
            "--depth-white 4095");
}

TEST_F(RemediesTest, turnBlackAndWhite) {
  // Black is near.
  const FrameFiles files =
      pair(16, [](int x, int y) { return 60000 - 80000 * (1 / double{roomAt(x, y)} - 0.25); });
  const std::string spread = "--input relative --depth-near 0.5 --depth-far 4";
  EXPECT_EQ(remedyOf(inspected(files, spread), "inside-out"), "--black-near");
  EXPECT_THAT(inspected(files, "--input relative --black-near").suspicions, IsEmpty());
}

TEST_F(RemediesTest, swapPlanesOfReversedDepth) {
  // Reversed depth between 1 and 5 m, which is read as forward.
  const FrameFiles files = exr([](int x, int y) { return (1 / roomAt(x, y) - 0.2F) / 0.8F; });
  const std::string wrong = "--depth-meaning window --depth-near 1 --depth-far 5";
  EXPECT_EQ(remedyOf(inspected(files, wrong), "inside-out"), "--depth-near 5 --depth-far 1");
}

TEST_F(RemediesTest, speakAsAManifest) {
  exr([](int x, int y) { return -roomAt(x, y); });
  folder_.write("frame.json", R"({"sources": [{"layers": [{"color": {"file": "scene.exr"},
      "depth": {"file": "scene.exr", "depth": {"meaning": "DEPTH_MEANING_PLANAR"}}}]}]})");
  const LayerInspection layer =
      inspected({.manifest = file("frame.json"), .deep = {}, .input = {}});
  EXPECT_EQ(remedyOf(layer, "empty"), R"({"scale":-1} in "depth")");
}

std::vector<std::string> notesOf(FrameFeed& feed) {
  std::vector<std::string> notes;
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(feed.next(i).ok());
    for (const std::string& note : feed.takeNotes()) notes.push_back(note);
  }
  for (const std::string& note : feed.takeLastNotes()) notes.push_back(note);
  return notes;
}

TEST_F(RemediesTest, areToldOnceByAFeedOfFiles) {
  const FrameFiles files = exr([](int x, int y) { return -roomAt(x, y); });
  FileFrames wrong({.is_looping = true}, {files, files});
  const std::vector<std::string> notes = notesOf(wrong);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0], HasSubstr("scene.exr: warning: empty: no sample is a surface: 100 % are "
                                  "negative; try --depth-scale -1"));
  const FrameFiles right = exr(roomAt);
  FileFrames clean({.is_looping = true}, {right, right});
  EXPECT_THAT(notesOf(clean), IsEmpty());
}

// An option without effect is refused, and the message names the inputs that take it.
TEST_F(RemediesTest, comeWithNoOptionInVain) {
  const FrameFiles files = pair(16, [](int x, int y) { return 1000 * double{roomAt(x, y)}; });
  const std::vector<std::pair<std::string, std::string>> refused{
      {"--input sensor --factor 30",
       "--factor has no effect with --input sensor here. It belongs to --input 2d+z"},
      {"--depth-side left", "--depth-side has no effect with --input plain"},
      {"--input sensor --black-near", "--black-near has no effect"},
      {"--input relative --depth-scale 0.1 --black-near", "--black-near has no effect"},
      {"--input relative --depth-offset 2", "--depth-offset has no effect"},
      {"--input relative --depth-meaning ray",
       "--depth-meaning window and ray do not fit --input relative"},
      {"--input openxr --depth-near 1 --depth-far 2 --depth-scale 3",
       "--depth-scale has no effect"},
      {"--input plain --camera-name v0", "--camera-name has no effect"},
      {"--camera-forward=-z", "--camera-forward has no effect"},
      {"--depth-invalid-is-far", "works only with --depth-invalid"},
      {"--tone-map agx", "--tone-map needs linear colour"},
  };
  for (const auto& [options, message] : refused) {
    const auto loaded = FrameLoader(withOptions(options)).load(files);
    EXPECT_FALSE(loaded.ok()) << options;
    EXPECT_THAT(std::string(loaded.status().message()), HasSubstr(message)) << options;
  }
  const FrameFiles exr_file = exr(roomAt);
  EXPECT_TRUE(FrameLoader(withOptions("--camera-forward=-z --tone-map agx")).load(exr_file).ok());
}

TEST_F(RemediesTest, needFilesToBeFor) {
  FileFeedOptions options{.manifests = {"frame.json"}};
  options.loader = withOptions("--depth-scale 2");
  EXPECT_THAT(std::string(framesOf(options).status().message()),
              HasSubstr("--depth-scale describes files of colour and depth"));
  options.loader = withOptions("--tone-map agx");
  EXPECT_TRUE(framesOf(options).ok());
  FileFeedOptions deep{.deeps = {"deep.exr"}};
  deep.loader = withOptions("--input sensor");
  EXPECT_THAT(std::string(framesOf(deep).status().message()),
              HasSubstr("--input cannot be combined with --deep"));
  FileFeedOptions pictures{.colors = {"a.png"}, .depths = {"b.png"}, .view = "left"};
  EXPECT_THAT(std::string(framesOf(pictures).status().message()),
              HasSubstr("--view chooses a view of an EXR file"));
}

}  // namespace
}  // namespace viewloom::cli::remedies_test
