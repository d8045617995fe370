// SPDX-License-Identifier: Apache-2.0
#include "containment/file_grants.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>

namespace viewloom::file_grants_test {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::Not;

std::vector<std::string> pathsOf(const std::vector<FileGrant>& grants, FileAccess access) {
  std::vector<std::string> paths;
  for (const FileGrant& grant : grants) {
    if (grant.access == access) paths.push_back(grant.path.lexically_normal().string());
  }
  return paths;
}

Environment environmentOf(std::map<std::string, std::string> variables) {
  return [variables](const char* name) {
    const auto found = variables.find(name);
    return found == variables.end() ? std::nullopt : std::optional(found->second);
  };
}

class FileGrants : public testing::Test {
 protected:
  FileGrants() { fs::create_directories(folder_); }
  ~FileGrants() override { fs::remove_all(folder_); }

  const fs::path folder_ = testing::TempDir() + "viewloom-grants-" +
                           testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(FileGrants, letLibrariesReadTheSystemButNotItsSecrets) {
  const auto readable = pathsOf(librariesGrants(environmentOf({})), FileAccess::kRead);
  EXPECT_THAT(readable, Contains("/usr"));
  EXPECT_THAT(readable, Contains("/etc/ssl/certs"));
  for (const char* secret : {"/", "/etc", "/etc/shadow", "/etc/ssl", "/etc/ssl/private", "/etc/pki",
                             "/etc/pki/tls", "/root", "/home", "/var", "/proc"}) {
    EXPECT_THAT(readable, Not(Contains(secret)));
  }
}

TEST_F(FileGrants, letTheServerReadTheLimitsOfItsCgroup) {
  const auto readable = pathsOf(librariesGrants(environmentOf({})), FileAccess::kRead);
  EXPECT_THAT(readable, Contains("/proc/self"));
  EXPECT_THAT(readable, Contains("/sys"));
}

TEST_F(FileGrants, letNobodyWriteButToCachesAndDevices) {
  EXPECT_THAT(pathsOf(librariesGrants(environmentOf({{"HOME", "/h"}})), FileAccess::kKeep),
              testing::IsEmpty());
  EXPECT_THAT(pathsOf(driverCacheGrants(environmentOf({{"HOME", "/h"}})), FileAccess::kKeep),
              Contains("/h/.cache/mesa_shader_cache"));
  EXPECT_THAT(pathsOf(driverCacheGrants(environmentOf({{"HOME", "/h"}, {"XDG_CACHE_HOME", "/c"}})),
                      FileAccess::kKeep),
              Contains("/c/mesa_shader_cache"));
  EXPECT_THAT(driverCacheGrants(environmentOf({})), testing::IsEmpty());
}

TEST_F(FileGrants, takeDriversAndLayersThatTheEnvironmentNamesWithTheirLibraries) {
  std::ofstream(folder_ / "layer.json") << R"({"layer": {"library_path": "/far/away/layer.so"}})";
  std::ofstream(folder_ / "driver.json") << R"({"ICD": {"library_path": "../beside/driver.so"}})";
  std::ofstream(folder_ / "no.json") << R"({"ICD": [)";
  const auto readable =
      pathsOf(librariesGrants(environmentOf({{"VK_LAYER_PATH", "/none:" + folder_.string()}})),
              FileAccess::kRead);
  EXPECT_THAT(readable, Contains(folder_.string()));
  EXPECT_THAT(readable, Contains("/far/away"));
  EXPECT_THAT(readable, Contains((folder_.parent_path() / "beside").string()));
}

TEST_F(FileGrants, followTheLinksOfAFileThatIsReplaced) {
  fs::create_directories(folder_ / "live");
  fs::create_directories(folder_ / "archive");
  std::ofstream(folder_ / "archive" / "cert1.pem") << "x";
  fs::create_symlink("../archive/cert1.pem", folder_ / "live" / "cert.pem");
  const auto readable = pathsOf(replaceableFile(folder_ / "live" / "cert.pem"), FileAccess::kRead);
  EXPECT_THAT(readable,
              testing::ElementsAre((folder_ / "live").string(), (folder_ / "archive").string()));
}

TEST_F(FileGrants, endWhereLinksFormACircle) {
  fs::create_symlink("b", folder_ / "a");
  fs::create_symlink("a", folder_ / "b");
  EXPECT_FALSE(replaceableFile(folder_ / "a").empty());
}

}  // namespace
}  // namespace viewloom::file_grants_test
