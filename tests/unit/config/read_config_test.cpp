// SPDX-License-Identifier: Apache-2.0
#include "config/read_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace viewloom::read_config_test {
namespace {

using testing::HasSubstr;

class ReadConfig : public testing::Test {
 protected:
  ~ReadConfig() override { std::filesystem::remove(path_); }

  ConfigSources file(const std::string& toml) {
    std::ofstream(path_) << toml;
    return {.file = path_};
  }

  static std::string errorOf(const ConfigSources& sources) {
    try {
      readConfig(sources);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  }

  std::string path_ = testing::TempDir() + "viewloomd-" +
                      testing::UnitTest::GetInstance()->current_test_info()->name() + ".toml";
};

TEST_F(ReadConfig, startsFromTheDefaults) {
  const Config config = readConfig({});
  EXPECT_EQ(config.grpc.address, "127.0.0.1:50051");
  EXPECT_EQ(config.http.address, "127.0.0.1:8080");
  EXPECT_TRUE(config.http.enabled);
  EXPECT_EQ(config.limits.plane_side_px_max, 8192U);
  EXPECT_EQ(config.device, "");
}

TEST_F(ReadConfig, takesTheFileThenTheEnvironmentThenFlags) {
  ConfigSources sources = file(
      "device = \"a # b\"\n[limits]\nstreams_max = 2\ndisplays_max = 3\nviews_max = 4\n"
      "[http]\nenabled = false\n");
  sources.environment = {{"VIEWLOOM_LIMITS_DISPLAYS_MAX", "30"},
                         {"VIEWLOOM_LIMITS_VIEWS_MAX", "40"}};
  sources.flags = {{"limits.views_max", "400"}};
  const Config config = readConfig(sources);
  EXPECT_EQ(config.device, "a # b");
  EXPECT_FALSE(config.http.enabled);
  EXPECT_EQ(config.limits.streams_max, 2U);
  EXPECT_EQ(config.limits.displays_max, 30U);
  EXPECT_EQ(config.limits.views_max, 400U);
}

TEST_F(ReadConfig, refusesAKeyThatDoesNotExistAndGuessesTheRightOne) {
  const std::string error = errorOf(file("[grpc]\naddress = \"[::1]:0\"\nadress = \"x\"\n"));
  EXPECT_THAT(error, HasSubstr(path_ + ":3: grpc.adress is no setting"));
  EXPECT_THAT(error, HasSubstr("did you mean \"grpc.address\"?"));
  EXPECT_THAT(errorOf(file("colour = 1\n")),
              HasSubstr("viewloomd.example.toml lists all settings"));
  EXPECT_THAT(errorOf({.flags = {{"log.leve", "info"}}}), HasSubstr("did you mean \"log.level\"?"));
  EXPECT_THAT(errorOf({.environment = {{"VIEWLOOM_GRPC_ADRESS", "x"}}}),
              HasSubstr("did you mean \"VIEWLOOM_GRPC_ADDRESS\"?"));
}

TEST_F(ReadConfig, leavesVariablesOfOthersAlone) {
  EXPECT_EQ(errorOf({.environment = {{"VIEWLOOM_REQUIRE_GPU", "1"}, {"HOME", "/root"}}}),
            "no error");
}

TEST_F(ReadConfig, refusesValuesOutOfRangeAndSaysWhatIsAccepted) {
  EXPECT_THAT(errorOf(file("[limits]\nplane_side_px_max = 8193\n")),
              HasSubstr("limits.plane_side_px_max is 8193, must be 1..8192 px"));
  EXPECT_THAT(errorOf(file("[limits]\nstreams_max = 0\n")), HasSubstr("must be 1..1024"));
  EXPECT_THAT(errorOf(file("[limits]\nstreams_max = -1\n")), HasSubstr("is -1"));
  EXPECT_THAT(errorOf({.flags = {{"limits.streams_max", "99999999999999999999"}}}),
              HasSubstr("must be 1..1024"));
  EXPECT_THAT(errorOf({.flags = {{"log.level", "loud"}}}),
              HasSubstr("log.level is \"loud\", must be trace, debug, info, warn, error or off"));
}

TEST_F(ReadConfig, refusesValuesOfAnotherType) {
  EXPECT_THAT(errorOf(file("validation = 1\n")), HasSubstr("is 1, must be true or false"));
  EXPECT_THAT(errorOf(file("device = 1.5\n")), HasSubstr("is 1.5"));
  EXPECT_THAT(errorOf(file("[limits]\nviews_max = \"9\"\n")), HasSubstr("is \"9\""));
  EXPECT_THAT(errorOf(file("device = [1]\n")), HasSubstr("not a list"));
  EXPECT_THAT(errorOf(file("grpc = 1\n")), HasSubstr("grpc is no setting"));
  EXPECT_THAT(errorOf({.flags = {{"validation", "yes"}}}), HasSubstr("must be true or false"));
}

TEST_F(ReadConfig, refusesAddressesThatAreNone) {
  for (const char* address :
       {"", "50051", ":50051", "host", "host:", "host:65536", "host:-1", "::1:5", "host:1x"}) {
    EXPECT_THAT(errorOf({.flags = {{"http.address", address}}}), HasSubstr("HOST:PORT")) << address;
  }
  for (const char* address : {"0.0.0.0:0", "[::]:8080", "localhost:65535"}) {
    EXPECT_EQ(errorOf({.flags = {{"http.address", address}}}), "no error") << address;
  }
  EXPECT_EQ(errorOf({.flags = {{"grpc.address", "unix:/run/viewloom.sock"}}}), "no error");
  EXPECT_NE(errorOf({.flags = {{"http.address", "unix:/run/viewloom.sock"}}}), "no error");
}

TEST_F(ReadConfig, takesHostNamesWithoutSpaces) {
  EXPECT_EQ(errorOf({.flags = {{"http.allowed_hosts", "a.example,b-2.example"}}}), "no error");
  EXPECT_THAT(errorOf({.flags = {{"http.allowed_hosts", "a, b"}}}),
              HasSubstr("must be host names, separated by commas"));
}

TEST_F(ReadConfig, takesOriginsAsBrowsersSendThem) {
  const char* good = "https://a.example,http://10.0.0.7:3000,http://[::1]:80";
  EXPECT_EQ(errorOf({.flags = {{"http.allowed_origins", good}}}), "no error");
  for (const char* bad : {"a.example", "*", "https://", "https://a.example/", "ftp://a.example",
                          "https://a.example, https://b.example", "https://u@a.example"}) {
    EXPECT_THAT(errorOf({.flags = {{"http.allowed_origins", bad}}}),
                HasSubstr("addresses as https://HOST"))
        << bad;
  }
}

TEST_F(ReadConfig, saysWhereAFileIsNoToml) {
  EXPECT_THAT(errorOf(file("device = \"a\"\n[grpc\n")), HasSubstr(path_ + ":2: "));
  EXPECT_THAT(errorOf({.file = "/nonexistent/viewloomd.toml"}),
              HasSubstr("/nonexistent/viewloomd.toml"));
}

TEST_F(ReadConfig, refusesWhatIsNoSettingsFileInOneSentence) {
  EXPECT_THAT(errorOf({.file = testing::TempDir()}), HasSubstr("is a folder, not a file"));
  EXPECT_THAT(errorOf({.file = "/nonexistent/viewloomd.toml"}), HasSubstr("there is no such file"));
  EXPECT_THAT(errorOf({.file = ""}), HasSubstr("there is no such file"));
  EXPECT_THAT(errorOf({.file = "/dev/null"}), HasSubstr("is no regular file"));
  EXPECT_THAT(errorOf(file(std::string("device\0 = 1", 11))), HasSubstr("is no text"));
  EXPECT_THAT(errorOf(file(std::string((size_t{1} << 20) + 1, '#'))), HasSubstr("1048576"));
  ASSERT_EQ(mkfifo((path_ + ".fifo").c_str(), 0600), 0);
  EXPECT_THAT(errorOf({.file = path_ + ".fifo"}), HasSubstr("is no regular file"));
  std::filesystem::remove(path_ + ".fifo");
}

TEST(ThreadCount, takesOnePerCoreForZero) {
  EXPECT_EQ(threadCount(5), 5U);
  EXPECT_GE(threadCount(0), 1U);
  EXPECT_LE(threadCount(0), 8U);
}

}  // namespace
}  // namespace viewloom::read_config_test
