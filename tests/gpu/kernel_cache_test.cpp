// SPDX-License-Identifier: Apache-2.0
// Kernels that an earlier server has kept, as a later one finds them.
#include "gpu/kernel_cache.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace viewloom::kernel_cache_test {
namespace {

using Bytes = std::vector<uint8_t>;

class KernelCacheTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string folder = (std::filesystem::temp_directory_path() / "kernels-XXXXXX").string();
    ASSERT_NE(mkdtemp(folder.data()), nullptr);
    folder_ = folder;
    file_ = folder_ / "made" / "kernels-01";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Bytes found() const { return KernelCache(file_).read(); }

  std::filesystem::path folder_;
  std::filesystem::path file_;
};

TEST_F(KernelCacheTest, keepsWhatItIsGivenInAFolderThatItMakes) {
  EXPECT_TRUE(found().empty());
  KernelCache(file_).write(Bytes{1, 2, 3});
  EXPECT_EQ(found(), (Bytes{1, 2, 3}));
  KernelCache(file_).write(Bytes{4});
  EXPECT_EQ(found(), Bytes{4});
}

TEST_F(KernelCacheTest, takesADamagedFileForNone) {
  KernelCache(file_).write(Bytes(1000, 7));
  const auto size = std::filesystem::file_size(file_);
  std::filesystem::resize_file(file_, size - 1);
  EXPECT_TRUE(found().empty()) << "cut off";
  KernelCache(file_).write(Bytes(1000, 7));
  std::fstream(file_, std::ios::in | std::ios::out | std::ios::binary).seekp(500).put('x');
  EXPECT_TRUE(found().empty()) << "a byte is another";
  std::ofstream(file_) << "something else that is long enough for a head";
  EXPECT_TRUE(found().empty());
}

TEST_F(KernelCacheTest, leavesTheFileAloneWhileNothingIsNew) {
  KernelCache(file_).write(Bytes{1, 2, 3});
  KernelCache again(file_);
  ASSERT_EQ(again.read().size(), 3U);
  std::filesystem::remove(file_);
  again.write(Bytes{1, 2, 3});
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(KernelCacheTest, goesOnWhereNothingCanBeWritten) {
  std::ofstream(folder_ / "made") << "a file where the folder should be";
  KernelCache(file_).write(Bytes{1});
  EXPECT_TRUE(found().empty());
}

}  // namespace
}  // namespace viewloom::kernel_cache_test
