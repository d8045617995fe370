// SPDX-License-Identifier: Apache-2.0
#include "cli/atlas_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <set>
#include <string>

#include "unit/client/chained_coder.h"
#include "unit/client/test_files.h"

namespace viewloom::cli::atlas_files_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

// 2x1 views of 4x4 px, raw colour.
Atlas atlasOf(uint64_t sequence, const std::string& suffix = "_qs2x1a1") {
  v1::AtlasLayout layout;
  layout.mutable_size()->set_width(8);
  layout.mutable_size()->set_height(4);
  layout.mutable_tile_size()->set_width(4);
  layout.mutable_tile_size()->set_height(4);
  layout.set_columns(2);
  layout.set_rows(1);
  layout.set_view_count(2);
  layout.set_suffix(suffix);
  layout.mutable_encoding()->set_color(v1::BAND_ENCODING_RAW);
  Atlas atlas;
  atlas.layout = std::make_shared<const v1::AtlasLayout>(layout);
  atlas.header.set_frame_number(1);
  atlas.header.set_sequence(sequence);
  atlas.bands.push_back({.row_count = 4,
                         .encoding = v1::BAND_ENCODING_RAW,
                         .bytes = std::string(size_t{8} * 4 * 3, '\x40')});
  return atlas;
}

class AtlasFilesTest : public testing::Test {
 protected:
  AtlasFiles writer(const std::string& stream = "demo") {
    return AtlasFiles({.folder = folder_.path(), .stream = stream, .writes_png = true});
  }
  std::set<std::string> fileNames() const {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      names.insert(entry.path().filename().string());
    }
    return names;
  }

  files::TestFolder folder_;
};

TEST_F(AtlasFilesTest, saysWhichFilesItWrites) {
  AtlasFiles writer = this->writer();
  const auto written = writer.write(atlasOf(1));
  ASSERT_TRUE(written.ok()) << written.status();
  EXPECT_EQ(written->first, folder_.path() / "demo_000001_000001_qs2x1a1.png");
  EXPECT_EQ(written->count, 1U);
  AtlasFiles views({.folder = folder_.path(), .stream = "v", .writes_views = true});
  const auto single = views.write(atlasOf(1));
  ASSERT_TRUE(single.ok()) << single.status();
  EXPECT_THAT(describe(*single), HasSubstr("v_000001_000001_view000.jpg and 1 more"));
}

TEST_F(AtlasFilesTest, neverWritesANameAgainAfterARestart) {
  ASSERT_TRUE(writer().write(atlasOf(1)).ok());
  AtlasFiles second = writer();
  ASSERT_TRUE(second.write(atlasOf(1)).ok());
  ASSERT_TRUE(second.write(atlasOf(2)).ok());
  // The server was started again, and counts from the beginning.
  ASSERT_TRUE(second.write(atlasOf(1)).ok());
  EXPECT_THAT(
      fileNames(),
      ElementsAre("demo_000001_000001_qs2x1a1.png", "demo_r2_000001_000001_qs2x1a1.png",
                  "demo_r2_000001_000002_qs2x1a1.png", "demo_r3_000001_000001_qs2x1a1.png"));
}

TEST_F(AtlasFilesTest, leavesFilesOfAnotherWriterAlone) {
  AtlasFiles first = writer();
  AtlasFiles second = writer();
  ASSERT_TRUE(first.write(atlasOf(1)).ok());
  ASSERT_TRUE(second.write(atlasOf(1)).ok());
  EXPECT_EQ(fileNames().size(), 2U);
}

TEST_F(AtlasFilesTest, followsChainedVideoWhereANameIsTaken) {
  test::ChainedCoder coder;
  AtlasFiles writer = this->writer();
  ASSERT_TRUE(writer.write(coder.code(1, 0, 40)).ok());
  std::ofstream(folder_.path() / "demo_000000_000002.png") << "another writer's";
  const auto written = writer.write(coder.code(2, 1, 60));
  ASSERT_TRUE(written.ok()) << written.status();
  EXPECT_EQ(written->first.filename(), "demo_r2_000000_000002.png");
  EXPECT_TRUE(writer.write(coder.code(3, 2, 90)).ok());
}

TEST_F(AtlasFilesTest, writesNothingUnderANameThatLeadsElsewhere) {
  for (const char* suffix : {"/../../x", "_a/b", "\033[2J", "_a b"}) {
    AtlasFiles writer = this->writer();
    EXPECT_FALSE(writer.write(atlasOf(1, suffix)).ok()) << suffix;
  }
  AtlasFiles too_long = writer();
  EXPECT_FALSE(too_long.write(atlasOf(1, std::string(65, 'a'))).ok());
  EXPECT_TRUE(fileNames().empty());
  for (const std::string& stream : {std::string("../../x"), std::string("/tmp/x"), std::string(""),
                                    std::string("-rf"), std::string(4096, 'a')}) {
    AtlasFiles writer = this->writer(stream);
    const auto written = writer.write(atlasOf(1));
    ASSERT_TRUE(written.ok()) << written.status();
    EXPECT_EQ(written->first.parent_path(), folder_.path());
    EXPECT_FALSE(written->first.filename().string().starts_with("-"));
  }
}

}  // namespace
}  // namespace viewloom::cli::atlas_files_test
