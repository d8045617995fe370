// SPDX-License-Identifier: Apache-2.0
#include "access/watched_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace viewloom::watched_file_test {
namespace {

// The process can open no file while it lives.
class NoDescriptors {
 public:
  NoDescriptors() {
    getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit none{.rlim_cur = 0, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_NOFILE, &none);
  }
  ~NoDescriptors() { setrlimit(RLIMIT_NOFILE, &before_); }
  NoDescriptors(const NoDescriptors&) = delete;
  NoDescriptors& operator=(const NoDescriptors&) = delete;

 private:
  rlimit before_{};
};

class WatchedFileTest : public testing::Test {
 protected:
  ~WatchedFileTest() override { std::filesystem::remove(path_); }

  void write(const std::string& text) const { std::ofstream(path_) << text; }

  const std::string path_ = std::filesystem::temp_directory_path() /
                            ("viewloom_watched_file_test_" + std::to_string(getpid()));
  WatchedFile file_{path_, 100};
};

TEST_F(WatchedFileTest, isReadOnceForEachChange) {
  write("old");
  EXPECT_EQ(**file_.readIfChanged(), "old");
  EXPECT_FALSE(file_.readIfChanged()->has_value());
  write("newer");
  EXPECT_EQ(**file_.readIfChanged(), "newer");
}

TEST_F(WatchedFileTest, isReadOnceThereAreDescriptors) {
  write("old");
  ASSERT_TRUE(file_.readIfChanged().ok());
  write("newer");
  {
    const NoDescriptors none;
    EXPECT_FALSE(file_.readIfChanged().ok());
    ASSERT_TRUE(file_.readIfChanged().ok());  // told once
  }
  const auto text = file_.readIfChanged();
  ASSERT_TRUE(text.ok() && text->has_value());
  EXPECT_EQ(**text, "newer");
}

}  // namespace
}  // namespace viewloom::watched_file_test
