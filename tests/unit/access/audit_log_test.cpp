// SPDX-License-Identifier: Apache-2.0
#include "access/audit_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include <nlohmann/json.hpp>

namespace viewloom::audit_log_test {

using nlohmann::json;

class Audit : public testing::Test {
 protected:
  ~Audit() override { std::filesystem::remove(path_); }

  static std::vector<json> linesOf(const std::filesystem::path& path) {
    std::vector<json> lines;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) lines.push_back(json::parse(line));
    return lines;
  }
  std::vector<json> lines() const { return linesOf(path_); }
  static AuditEvent refusal() {
    return {.outcome = AuditOutcome::kRefused,
            .operation = "/ws",
            .peer = "10.0.0.7",
            .identity = nullptr,
            .stream = "demo",
            .reason = "it is \"no\" \xff token"};
  }

  const std::string path_ =
      std::filesystem::temp_directory_path() / ("viewloom_audit_test_" + std::to_string(getpid()));
  int64_t now_s_ = 1801396800;
  AuditLog log_{path_, [this] { return now_s_; }};
};

TEST_F(Audit, writesOneObjectALine) {
  log_.write(refusal());
  AuditEvent grant = refusal();
  grant.outcome = AuditOutcome::kGranted;
  grant.reason.clear();
  grant.identity = std::make_shared<Identity>(
      Identity{.id = "anna\n", .proof = Proof::kJwt, .rights = {}, .digest = {}, .expires_s = {}});
  log_.write(grant);
  const std::vector<json> written = lines();
  ASSERT_EQ(written.size(), 2U);
  EXPECT_EQ(written[0]["time"], "2027-01-31T12:00:00Z");
  EXPECT_EQ(written[0]["outcome"], "refused");
  EXPECT_EQ(written[0]["operation"], "/ws");
  EXPECT_EQ(written[0]["peer"], "10.0.0.7");
  EXPECT_EQ(written[0]["stream"], "demo");
  EXPECT_FALSE(written[0].contains("id"));
  EXPECT_EQ(written[1]["outcome"], "granted");
  EXPECT_EQ(written[1]["proof"], "jwt");
  EXPECT_EQ(written[1]["id"], "anna\n");
}

TEST_F(Audit, isForItsOwnerAlone) {
  struct stat status {};
  ASSERT_EQ(stat(path_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600U);
}

TEST_F(Audit, countsEqualEvents) {
  AuditEvent grant = refusal();
  grant.outcome = AuditOutcome::kGranted;
  for (int i = 0; i < 250; ++i, ++now_s_) {
    log_.write(refusal());
    log_.write(grant);
  }
  EXPECT_EQ(lines().size(), 2U);
  now_s_ += AuditWindow::kSeconds;
  log_.write(grant);
  const std::vector<json> written = lines();
  ASSERT_EQ(written.size(), 5U);
  for (const size_t line : {2U, 3U}) {
    EXPECT_EQ(written[line]["count"], 249);
    EXPECT_EQ(written[line]["time"], "2027-01-31T12:04:09Z");
    EXPECT_EQ(written[line]["stream"], "demo");
  }
  EXPECT_FALSE(written[4].contains("count"));
}

TEST_F(Audit, tellsEachChangeOfAFile) {
  AuditEvent change = refusal();
  change.outcome = AuditOutcome::kChanged;
  for (int i = 0; i < 3; ++i) log_.write(change);
  EXPECT_EQ(lines().size(), 3U);
}

TEST_F(Audit, tellsCountsAtItsEnd) {
  {
    AuditLog log(path_, [this] { return now_s_; });
    for (int i = 0; i < 3; ++i) log.write(refusal());
    EXPECT_EQ(lines().size(), 1U);
  }
  EXPECT_EQ(lines().back()["count"], 2);
}

TEST_F(Audit, cutsLongNames) {
  AuditEvent event = refusal();
  event.stream = std::string(5000, 'x');
  log_.write(event);
  EXPECT_EQ(lines().front()["stream"], std::string(128, 'x'));
}

TEST_F(Audit, goesOnInANewFileOnceItWasMoved) {
  log_.write(refusal());
  const std::string moved = path_ + ".1";
  std::filesystem::rename(path_, moved);
  AuditEvent other = refusal();
  other.stream = "hall";
  log_.write(other);
  EXPECT_EQ(lines().size(), 1U);
  EXPECT_EQ(linesOf(moved).size(), 1U);
  std::filesystem::remove(moved);
}

TEST(AuditLog, saysWhereItCannotWrite) {
  EXPECT_THROW(AuditLog("/nowhere/audit", systemSeconds), std::runtime_error);
  AuditLog none("", systemSeconds);
  none.write({});
}

}  // namespace viewloom::audit_log_test
