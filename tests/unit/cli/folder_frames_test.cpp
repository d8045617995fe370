// SPDX-License-Identifier: Apache-2.0
#include "cli/folder_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "support/deep_exr_writer.h"
#include "unit/client/test_files.h"
#include "unit/inputs/written_files.h"

namespace viewloom::cli::folder_frames_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class FolderFramesTest : public ::testing::Test {
 protected:
  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }
  std::unique_ptr<FolderFrames> open(const inputs::InputSettings& settings = {}) const {
    LoaderOptions options;
    options.input = settings;
    auto frames = FolderFrames::open(folder_.path(), options, "");
    EXPECT_TRUE(frames.ok()) << frames.status();
    return *std::move(frames);
  }
  // Flat EXR of one depth.
  static void writeWhole(const std::filesystem::path& path, float depth_m) {
    const auto constant = [](const char* name, float value) {
      return test::WrittenChannel{name, Imf::FLOAT, [value](int, int) { return value; }};
    };
    test::writeExr(path, 2, 2,
                   {constant("R", 1), constant("G", 1), constant("B", 1), constant("Z", depth_m)});
  }
  // The depth of the next frame's first px; 0 when there is none.
  static float next(FolderFrames& frames) {
    const auto frame = frames.next(0);
    EXPECT_TRUE(frame.ok()) << frame.status();
    if (!frame.ok() || !frame->has_value()) return 0;
    float depth = 0;
    std::memcpy(&depth, (*frame)->planes[1]->data(), sizeof(depth));
    return depth;
  }

  // Notes but for warnings, which come whenever the look at a frame is done.
  static std::vector<std::string> takeSkips(FolderFrames& frames) {
    std::vector<std::string> notes = frames.takeNotes();
    std::erase_if(notes, [](const std::string& note) {
      return note.find(": warning: ") != std::string::npos;
    });
    return notes;
  }

  const files::TestFolder folder_;
};

TEST_F(FolderFramesTest, takesWhatIsThereByNameAndThenWhatComes) {
  writeWhole(file("b.exr"), 2);
  writeWhole(file("a.exr"), 1);
  const auto frames = open();
  EXPECT_EQ(next(*frames), 1);
  EXPECT_EQ(next(*frames), 2);
  EXPECT_EQ(next(*frames), 0);
  EXPECT_FALSE(frames->hasEnded());
  writeWhole(file("c.exr"), 3);
  writeWhole(file("a.exr"), 4);
  EXPECT_EQ(next(*frames), 3);
  EXPECT_EQ(next(*frames), 4) << "written anew";
  EXPECT_EQ(next(*frames), 0);
}

TEST_F(FolderFramesTest, waitsForFilesThatAreBeingWritten) {
  writeWhole(file("whole"), 5);
  const std::string bytes = files::bytesOf(file("whole"));
  std::ofstream early(file("early.exr"), std::ios::binary);
  early << bytes.substr(0, bytes.size() / 2) << std::flush;
  const auto frames = open();
  EXPECT_EQ(next(*frames), 0) << "there before, but open";
  std::ofstream late(file("late.exr"), std::ios::binary);
  late << bytes.substr(0, bytes.size() - 1) << std::flush;
  EXPECT_EQ(next(*frames), 0);
  late << bytes.substr(bytes.size() - 1);
  late.close();
  EXPECT_EQ(next(*frames), 5);
  early << bytes.substr(bytes.size() / 2);
  early.close();
  EXPECT_EQ(next(*frames), 5);
  EXPECT_THAT(takeSkips(*frames), IsEmpty());
  // Careful programs write to another name, then rename the file.
  std::filesystem::rename(file("whole"), file("moved.exr"));
  EXPECT_EQ(next(*frames), 5);
}

TEST_F(FolderFramesTest, skipsBrokenFilesWithALineEach) {
  const auto frames = open();
  writeWhole(file("a.exr"), 1);
  const std::string bytes = files::bytesOf(file("a.exr"));
  folder_.write("cut.exr", bytes.substr(0, bytes.size() - 10));
  folder_.write("text.exr", "no picture");
  writeWhole(file("b.exr"), 2);
  EXPECT_EQ(next(*frames), 1);
  EXPECT_EQ(next(*frames), 2);
  EXPECT_THAT(takeSkips(*frames),
              ElementsAre(HasSubstr("text.exr: is no EXR file"), HasSubstr("cut.exr: ")));
  EXPECT_THAT(frames->description(), HasSubstr("2 read, 2 skipped"));
}

TEST_F(FolderFramesTest, pairsPicturesWithTheirDepth) {
  const auto frames = open({.kind = inputs::InputKind::kSensor});
  test::writePng(file("cam_1.png"), 2, 2, 3, 8, std::vector<uint16_t>(12, 7));
  EXPECT_EQ(next(*frames), 0);
  test::writePng(file("cam_1_depth.png"), 2, 2, 1, 16, std::vector<uint16_t>(4, 1234));
  const auto frame = frames->next(0);
  ASSERT_TRUE(frame.ok() && frame->has_value());
  EXPECT_EQ((*frame)->header.sources(0).layers(0).planes(1).depth().scale(), 0.001);
  EXPECT_THAT((*frame)->planes, SizeIs(2));
}

TEST_F(FolderFramesTest, splitsDeepFiles) {
  const Imath::Box2i window(Imath::V2i(0, 0), Imath::V2i(0, 0));
  test::writeDeepExr(file("deep.exr"), {.data = window, .display = window, .pixels = {{}}}, {});
  const auto frames = open();
  const auto frame = frames->next(0);
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_TRUE(frame->has_value());
}

TEST_F(FolderFramesTest, endsWhenTheFolderIsGone) {
  std::filesystem::create_directory(file("inside"));
  auto frames = FolderFrames::open(file("inside"), {}, "");
  ASSERT_TRUE(frames.ok()) << frames.status();
  std::filesystem::remove(file("inside"));
  EXPECT_THAT(std::string((*frames)->next(0).status().message()), HasSubstr("deleted"));
}

TEST_F(FolderFramesTest, refusesWhatIsNoFolder) {
  folder_.write("file", "");
  for (const char* name : {"file", "nothing"}) {
    EXPECT_THAT(std::string(FolderFrames::open(file(name), {}, "").status().message()),
                HasSubstr("cannot be watched"));
  }
}

}  // namespace
}  // namespace viewloom::cli::folder_frames_test
