// SPDX-License-Identifier: Apache-2.0
#include "base/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <string>

namespace viewloom::output_file_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class OutputFileTest : public testing::Test {
 protected:
  OutputFileTest() {
    folder_ = testing::TempDir() + "output-" + std::to_string(getpid());
    fs::create_directory(folder_);
  }
  ~OutputFileTest() override { fs::remove_all(folder_); }

  static absl::Status write(const fs::path& path, const std::string& bytes) {
    auto out = OutputFile::create(path);
    if (!out.ok()) return out.status();
    VIEWLOOM_RETURN_IF_ERROR((*out)->write(bytes));
    return (*out)->replace();
  }
  static std::string textOf(const fs::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  size_t fileCount() const {
    return size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

TEST_F(OutputFileTest, filesOfRootBelongToTheOwnerOfTheirFolderOrOfTheFileBefore) {
  if (geteuid() != 0) GTEST_SKIP() << "only root gives files away";
  constexpr uid_t kService = 1234;
  constexpr uid_t kOther = 1235;
  const fs::path path = folder_ / "a.txt";
  const auto owner_of_next = [&path] {
    const auto out = OutputFile::create(path);
    EXPECT_EQ((*out)->keepOwner(), absl::OkStatus());
    EXPECT_EQ((*out)->replace(), absl::OkStatus());
    struct stat status {};
    EXPECT_EQ(lstat(path.c_str(), &status), 0);
    return status.st_uid;
  };
  EXPECT_EQ(owner_of_next(), 0U);
  fs::remove(path);
  ASSERT_EQ(chown(folder_.c_str(), kService, kService), 0);
  EXPECT_EQ(owner_of_next(), kService);
  ASSERT_EQ(chown(path.c_str(), kOther, kOther), 0);
  EXPECT_EQ(owner_of_next(), kOther);
}

TEST_F(OutputFileTest, replacesARegularFileWhenItIsComplete) {
  const fs::path path = folder_ / "a.txt";
  ASSERT_EQ(write(path, "old"), absl::OkStatus());
  {
    const auto out = OutputFile::create(path);
    ASSERT_TRUE(out.ok());
    ASSERT_EQ((*out)->write("new"), absl::OkStatus());
    EXPECT_EQ(textOf(path), "old");
  }
  EXPECT_EQ(textOf(path), "old") << "it was not completed";
  EXPECT_EQ(fileCount(), 1U);
  ASSERT_EQ(write(path, "new"), absl::OkStatus());
  EXPECT_EQ(textOf(path), "new");
}

TEST_F(OutputFileTest, replacesNothingElse) {
  fs::create_directory(folder_ / "folder");
  fs::create_symlink(folder_ / "target", folder_ / "link");
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(write(folder_ / "folder", "x").ToString(), HasSubstr("is a folder"));
  EXPECT_THAT(write(folder_ / "link", "x").ToString(), HasSubstr("is a symbolic link"));
  EXPECT_THAT(write(folder_ / "pipe", "x").ToString(), HasSubstr("is a pipe"));
  EXPECT_THAT(write("/dev/null", "x").ToString(), HasSubstr("is a device"));
  EXPECT_THAT(write(folder_ / "none" / "a", "x").ToString(), HasSubstr("No such file"));
  EXPECT_THAT(write("", "x").ToString(), HasSubstr("is no name of a file"));
  EXPECT_FALSE(fs::exists(folder_ / "target"));
  struct stat status {};
  ASSERT_EQ(stat("/dev/null", &status), 0);
  EXPECT_TRUE(S_ISCHR(status.st_mode));
}

TEST_F(OutputFileTest, followsNoLinkThatWaitsAtItsSide) {
  fs::create_symlink(folder_ / "target", folder_ / "a.txt.part");
  EXPECT_THAT(write(folder_ / "a.txt", "x").ToString(), HasSubstr("a.txt.part: is a symbolic"));
  EXPECT_FALSE(fs::exists(folder_ / "target"));
}

TEST_F(OutputFileTest, placesANewFileWithoutReplacingAnything) {
  const fs::path path = folder_ / "a.txt";
  ASSERT_EQ(write(path, "old"), absl::OkStatus());
  auto out = OutputFile::create(path);
  ASSERT_TRUE(out.ok());
  EXPECT_EQ((*out)->placeNew().value(), false);
  out->reset();
  EXPECT_EQ(textOf(path), "old");
  out = OutputFile::create(folder_ / "b.txt");
  ASSERT_TRUE(out.ok());
  EXPECT_EQ((*out)->placeNew().value(), true);
  out->reset();
  EXPECT_EQ(fileCount(), 2U);
}

TEST_F(OutputFileTest, saysThatItReachedTheLargestSizeAllowed) {
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{.rlim_cur = 1000, .rlim_max = before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const absl::Status status = write(folder_ / "a.txt", std::string(2000, 'x'));
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_THAT(status.ToString(), HasSubstr("a.txt: cannot be written: it reached the largest"));
  EXPECT_EQ(fileCount(), 0U);
}

TEST_F(OutputFileTest, movesWhatIsWrittenBehindAFront) {
  const std::string body(3'000'000, 'b');
  auto out = OutputFile::create(folder_ / "a");
  ASSERT_TRUE(out.ok()) << out.status();
  ASSERT_TRUE((*out)->write(body + "end").ok());
  ASSERT_TRUE((*out)->insertFront("front").ok());
  EXPECT_EQ((*out)->size(), body.size() + 8);
  ASSERT_TRUE((*out)->write("!").ok());
  ASSERT_TRUE((*out)->replace().ok());
  EXPECT_EQ(textOf(folder_ / "a"), "front" + body + "end!");
}

TEST_F(OutputFileTest, staysAsItIsWithoutRoomForAFront) {
  signal(SIGXFSZ, SIG_IGN);
  auto out = OutputFile::create(folder_ / "a");
  ASSERT_TRUE(out.ok()) << out.status();
  ASSERT_TRUE((*out)->write("body").ok());
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 8;
  setrlimit(RLIMIT_FSIZE, &small);
  const absl::Status inserted = (*out)->insertFront("too long");
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(inserted.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ((*out)->size(), 4U);
  ASSERT_TRUE((*out)->replace().ok());
  EXPECT_EQ(textOf(folder_ / "a"), "body");
}

}  // namespace
}  // namespace viewloom::output_file_test
