// SPDX-License-Identifier: Apache-2.0
#include "access/audit_window.h"

#include <gtest/gtest.h>

namespace viewloom::audit_window_test {

constexpr int64_t kNow_s = 1'800'000'000;

AuditEvent grantOf(const std::string& stream, const std::string& peer = "10.0.0.7",
                   const std::string& id = "") {
  AuditEvent event{.operation = "/still/", .peer = peer, .stream = stream};
  if (id.empty()) return event;
  event.identity = std::make_shared<Identity>(
      Identity{.id = id, .proof = Proof::kToken, .rights = {}, .digest = {}, .expires_s = {}});
  return event;
}

// Lines of distinct events that come now.
size_t lineCount(AuditWindow& window, const std::string& peer, const std::string& id,
                 size_t event_count) {
  size_t count = 0;
  for (size_t i = 0; i < event_count; ++i) {
    count += window.isNew(grantOf(std::to_string(i), peer, id), kNow_s);
  }
  return count;
}

TEST(AuditWindow, tellsDifferentEventsApart) {
  AuditWindow window;
  AuditEvent refused = grantOf("a");
  refused.outcome = AuditOutcome::kRefused;
  AuditEvent other_reason = refused;
  other_reason.reason = "why";
  AuditEvent other_operation = grantOf("a");
  other_operation.operation = "/ws";
  for (const AuditEvent& event :
       {grantOf("a"), grantOf("b"), grantOf("a", "10.0.0.8"), grantOf("a", "10.0.0.7", "anna"),
        grantOf("a", "10.0.0.7", "bert"), refused, other_reason, other_operation}) {
    EXPECT_TRUE(window.isNew(event, kNow_s));
    EXPECT_FALSE(window.isNew(event, kNow_s + 1));
  }
  const auto counted = window.close();
  ASSERT_EQ(counted.size(), 8U);
  for (const AuditWindow::Counted& one : counted) {
    EXPECT_EQ(one.event.count, 1U);
    EXPECT_EQ(one.last_s, kNow_s + 1);
  }
}

TEST(AuditWindow, endsSoLongAfterItsFirstEvent) {
  AuditWindow window;
  EXPECT_FALSE(window.isOver(kNow_s));
  window.isNew(grantOf("a"), kNow_s);
  EXPECT_FALSE(window.isOver(kNow_s + AuditWindow::kSeconds - 1));
  EXPECT_TRUE(window.isOver(kNow_s + AuditWindow::kSeconds));
  EXPECT_TRUE(window.isOver(kNow_s - 1)) << "a clock that was set back";
  EXPECT_TRUE(window.close().empty()) << "nothing came twice";
  EXPECT_TRUE(window.isNew(grantOf("a"), kNow_s));
}

TEST(AuditWindow, leavesLinesToOtherClients) {
  constexpr size_t kMore = 5;
  AuditWindow window;
  const size_t flood = AuditWindow::kClientLinesMax + kMore;
  EXPECT_EQ(lineCount(window, "2001:db8::1", "", flood / 2), flood / 2);
  // The same client: it has all addresses of its network.
  EXPECT_EQ(lineCount(window, "2001:db8::2", "", flood - flood / 2), flood - flood / 2 - kMore);
  EXPECT_EQ(lineCount(window, "10.0.0.8", "", 1), 1U);
  EXPECT_EQ(lineCount(window, "2001:db8::1", "anna", flood), AuditWindow::kClientLinesMax);
  const auto counted = window.close();
  ASSERT_EQ(counted.size(), 2U);
  for (const AuditWindow::Counted& one : counted) {
    EXPECT_EQ(one.event.operation, "audit");
    EXPECT_EQ(one.event.count, kMore);
  }
}

TEST(AuditWindow, holdsSoManyLinesOfAll) {
  AuditWindow window;
  size_t line_count = 0;
  for (int client = 0; client < 15; ++client) {
    line_count += lineCount(window, "", "client-" + std::to_string(client), 1000);
  }
  EXPECT_EQ(line_count, AuditWindow::kLinesMax);
  const auto counted = window.close();
  ASSERT_EQ(counted.size(), 1U);
  EXPECT_EQ(counted[0].event.count, 5000U);
  EXPECT_EQ(counted[0].event.identity, nullptr);
}

}  // namespace viewloom::audit_window_test
