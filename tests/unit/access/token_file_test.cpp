// SPDX-License-Identifier: Apache-2.0
#include "access/token_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "access/watched_file.h"

namespace viewloom::token_file_test {

using testing::HasSubstr;

class TokenFile : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static TokenEntry entry(const std::string& id) {
    return {.identity = std::make_shared<Identity>(Identity{.id = id,
                                                            .proof = Proof::kToken,
                                                            .rights = allRights(),
                                                            .digest = sha256(id),
                                                            .expires_s = {}}),
            .note = ""};
  }
  std::vector<std::string> ids() const {
    std::vector<std::string> ids;
    const auto list = readTokenFile(path_);
    if (!list.ok()) return {"unreadable"};
    for (const TokenEntry& e : list->entries()) ids.push_back(e.identity->id);
    return ids;
  }

  const std::filesystem::path folder_ = std::filesystem::temp_directory_path() /
                                        ("viewloom_token_file_test_" + std::to_string(getpid()));
  const std::string path_ = folder_ / "tokens.jsonl";
};

TEST_F(TokenFile, isEmptyBeforeItIsThere) {
  EXPECT_THAT(ids(), testing::IsEmpty());
}

TEST_F(TokenFile, isForItsOwnerAlone) {
  ASSERT_TRUE(addToTokenFile(path_, entry("a")).ok());
  struct stat status {};
  ASSERT_EQ(stat(path_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600U);
}

TEST_F(TokenFile, keepsCommentsAndOtherLines) {
  std::ofstream(path_) << "# the lab\n" << tokenLine(entry("a"));  // no line break at the end
  ASSERT_TRUE(addToTokenFile(path_, entry("b")).ok());
  EXPECT_THAT(ids(), testing::ElementsAre("a", "b"));
  ASSERT_TRUE(removeFromTokenFile(path_, "a").ok());
  EXPECT_THAT(ids(), testing::ElementsAre("b"));
  EXPECT_THAT(*readSmallFile(path_, 1000), testing::StartsWith("# the lab\n{\"id\":\"b\""));
}

TEST_F(TokenFile, refusesWhatDoesNotFit) {
  ASSERT_TRUE(addToTokenFile(path_, entry("camera")).ok());
  EXPECT_EQ(addToTokenFile(path_, entry("camera")).code(), absl::StatusCode::kAlreadyExists);
  const absl::Status unknown = removeFromTokenFile(path_, "camra");
  EXPECT_EQ(unknown.code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(unknown.message()), HasSubstr("did you mean \"camera\"?"));
  EXPECT_FALSE(addToTokenFile(folder_ / "nowhere" / "tokens", entry("a")).ok());
  EXPECT_FALSE(addToTokenFile(folder_, entry("a")).ok());
}

TEST_F(TokenFile, isLeftAloneWhileItIsDamaged) {
  std::ofstream(path_) << "oops\n";
  EXPECT_FALSE(addToTokenFile(path_, entry("a")).ok());
  EXPECT_EQ(*readSmallFile(path_, 100), "oops\n");
}

TEST_F(TokenFile, takesChangesOfSeveralCommandsAtOnce) {
  {
    std::vector<std::jthread> commands;
    for (int i = 0; i < 8; ++i) {
      commands.emplace_back([this, i] {
        EXPECT_TRUE(addToTokenFile(path_, entry("token-" + std::to_string(i))).ok());
      });
    }
  }
  EXPECT_EQ(ids().size(), 8U);
}

TEST_F(TokenFile, isNoticedWhenItChanges) {
  WatchedFile file(path_, 100);
  EXPECT_FALSE(file.readIfChanged().ok());  // there is none: said once
  EXPECT_EQ(*file.readIfChanged(), std::nullopt);
  std::ofstream(path_) << "one";
  EXPECT_EQ(*file.readIfChanged(), "one");
  EXPECT_EQ(*file.readIfChanged(), std::nullopt);
  std::ofstream(path_) << std::string(101, 'x');
  EXPECT_THAT(std::string(file.readIfChanged().status().message()), HasSubstr("too long"));
  EXPECT_EQ(readSmallFile(folder_, 100).status().code(), absl::StatusCode::kFailedPrecondition);
}

// Else a token stays in force that was revoked while there was no descriptor left.
TEST_F(TokenFile, isReadOnceThereIsADescriptorForIt) {
  WatchedFile file(path_, 100);
  std::ofstream(path_) << "one";
  EXPECT_EQ(*file.readIfChanged(), "one");
  std::ofstream(path_) << "other";
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit none{.rlim_cur = 0, .rlim_max = before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  const absl::Status first = file.readIfChanged().status();
  const auto second = file.readIfChanged();
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_FALSE(first.ok());
  EXPECT_TRUE(second.ok() && !second->has_value()) << "said once";
  EXPECT_EQ(*file.readIfChanged(), "other");
}

}  // namespace viewloom::token_file_test
