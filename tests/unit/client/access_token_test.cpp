// SPDX-License-Identifier: Apache-2.0
#include "lib/access_token.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "lib/channel.h"

namespace viewloom::access_token_test {

using testing::HasSubstr;
using testing::Not;

class AccessToken : public testing::Test {
 protected:
  ~AccessToken() override {
    unsetenv("VIEWLOOM_TOKEN");
    std::filesystem::remove(path_);
  }

  absl::StatusOr<std::string> readAs(const std::string& text) const {
    std::ofstream(path_) << text;
    return readAccessToken(path_);
  }

  const std::string path_ = std::filesystem::temp_directory_path() /
                            ("viewloom_access_token_test_" + std::to_string(getpid()));
};

TEST_F(AccessToken, comesFromTheEnvironment) {
  unsetenv("VIEWLOOM_TOKEN");
  EXPECT_EQ(tokenOfEnvironment(), "");
  setenv("VIEWLOOM_TOKEN", " viewloom_abc\n", 1);
  EXPECT_EQ(tokenOfEnvironment(), "viewloom_abc");
  setenv("VIEWLOOM_TOKEN", " \n", 1);
  EXPECT_EQ(tokenOfEnvironment(), "");
}

TEST_F(AccessToken, comesFromAFileOfOneLine) {
  EXPECT_EQ(*readAs("viewloom_abc\n"), "viewloom_abc");
  EXPECT_EQ(*readAs("\tviewloom_abc"), "viewloom_abc");
  EXPECT_EQ(*readAs(std::string(8192, 'x')), std::string(8192, 'x'));
}

TEST_F(AccessToken, isNotReadFromOtherFiles) {
  for (const std::string& text :
       {std::string(), std::string("\n"), std::string("secret words"), std::string("secret\nmore"),
        std::string("secret\x01"), std::string("secret\xff"), std::string(9000, 's')}) {
    const absl::Status status = readAs(text).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(status.message()), Not(HasSubstr("secret")));
    EXPECT_THAT(std::string(status.message()), HasSubstr(path_));
  }
  EXPECT_FALSE(readAccessToken("/nowhere/token").ok());
  EXPECT_FALSE(readAccessToken(std::filesystem::temp_directory_path()).ok());
}

TEST_F(AccessToken, isRefusedByAChannelThatCannotSendIt) {
  EXPECT_NE(makeChannel("unix:nobody", "viewloom_abc"), nullptr);
  EXPECT_THROW(makeChannel("unix:nobody", "two words"), std::invalid_argument);
}

}  // namespace viewloom::access_token_test
