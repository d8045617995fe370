// SPDX-License-Identifier: Apache-2.0
// The matrix of roles, operations and stream patterns, and whether it is whole.
#include "access/operations.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <set>
#include <string>

#include "access/access_control.h"
#include "access/token_file.h"
#include "base/str_cat.h"
#include "viewloom/v1/catalog_service.pb.h"
#include "viewloom/v1/display_service.pb.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom::operations_test {

std::set<std::string> rpcsOfProtos() {
  std::set<std::string> names;
  for (const google::protobuf::FileDescriptor* file :
       {v1::OpenDisplay::descriptor()->file(), v1::PublishSettings::descriptor()->file(),
        v1::ListStreamsRequest::descriptor()->file()}) {
    for (int i = 0; i < file->service_count(); ++i) {
      const google::protobuf::ServiceDescriptor& service = *file->service(i);
      for (int m = 0; m < service.method_count(); ++m) {
        names.insert(strCat("/", service.full_name(), "/", service.method(m)->name()));
      }
    }
  }
  return names;
}

TEST(Operations, holdEveryRpcOfTheProtosAndNoOther) {
  std::set<std::string> listed;
  for (const Operation& operation : operations()) {
    if (operation.name.starts_with("/viewloom.v1.")) listed.emplace(operation.name);
  }
  EXPECT_EQ(listed, rpcsOfProtos());
  EXPECT_EQ(listed.size(), 7U);
}

TEST(Operations, areFoundByPath) {
  EXPECT_EQ(operationOf("/still/demo/portrait")->name, kStills);
  EXPECT_EQ(operationOf("/stream/demo.mjpg")->name, kPlayers);
  EXPECT_EQ(operationOf("/ws")->name, kWebSocket);
  for (const char* path : {"/ws/", "/still", "/", "/api/streams/", "/api/stream", "/metrics?", "",
                           "/viewloom.v1.CatalogService/Other"}) {
    EXPECT_FALSE(operationOf(path)) << path;
  }
}

// Rights of each role. A line for every operation: a new one has to be decided here, too.
struct Row {
  std::string_view name;
  bool for_publish;
  bool for_watch;
  bool for_operate;
  bool for_nobody;    // without a token
  bool needs_stream;  // only of the identity's patterns
};
constexpr Row kMatrix[] = {
    {kPublishFrames, true, false, false, false, true},
    {kStreamAtlases, false, true, false, false, true},
    {kListStreams, true, true, true, false, false},
    {kListDisplays, true, true, true, false, false},
    {kListPresets, true, true, true, false, false},
    {kGetServerInfo, true, true, true, false, false},
    {kAdviseSource, true, true, true, false, false},
    {kWebSocket, false, true, false, false, true},
    {kStills, false, true, false, false, true},
    {kPlayers, false, true, false, false, true},
    {kApiLink, false, true, false, false, true},
    {kApiQr, false, true, false, false, true},
    {kApiStreams, true, true, true, false, false},
    {kApiDisplays, true, true, true, false, false},
    {kApiPresets, true, true, true, false, false},
    {kApiFields, true, true, true, false, false},
    {kApiSession, true, true, true, false, false},
    {kMetricsPage, false, false, true, false, false},
    {kHealthPage, true, true, true, true, false},
};

bool isInRow(const Row& row, Role role) {
  return role == Role::kPublish ? row.for_publish
         : role == Role::kWatch ? row.for_watch
                                : row.for_operate;
}

class Matrix : public testing::Test {
 protected:
  Matrix() { std::filesystem::remove(path_); }
  ~Matrix() override { std::filesystem::remove(path_); }

  // Adds a token to the file.
  std::string tokenWith(const std::string& id, std::vector<Role> roles,
                        const std::vector<std::string>& streams) {
    std::string token = makeToken();
    const Rights rights{
        .roles = std::move(roles), .streams = StreamPatterns::parse(streams).value(), .quota = {}};
    EXPECT_TRUE(addToTokenFile(
                    path_, {.identity = std::make_shared<Identity>(Identity{.id = id,
                                                                            .proof = Proof::kToken,
                                                                            .rights = rights,
                                                                            .digest = sha256(token),
                                                                            .expires_s = {}}),
                            .note = ""})
                    .ok());
    return token;
  }

  const std::string path_ = std::filesystem::temp_directory_path() /
                            ("viewloom_operations_test_" + std::to_string(getpid()));
  ManualClock clock_;
};

TEST_F(Matrix, hasARowForEveryOperation) {
  std::set<std::string_view> rows;
  std::set<std::string_view> known;
  for (const Row& row : kMatrix) rows.insert(row.name);
  for (const Operation& operation : operations()) known.insert(operation.name);
  EXPECT_EQ(rows, known);
}

TEST_F(Matrix, holdsForEachRoleOperationAndPattern) {
  const std::vector<std::string> patterns[] = {{}, {"*"}, {"room.*"}, {"hall"}, {"hall", "room.1"}};
  struct Token {
    std::string text;
    std::vector<Role> roles;
    StreamPatterns streams;
  };
  std::vector<Token> tokens;
  for (unsigned bits = 1; bits < 8; ++bits) {
    std::vector<Role> roles;
    for (unsigned role = 0; role < 3; ++role) {
      if ((bits >> role & 1U) != 0) roles.push_back(static_cast<Role>(role));
    }
    for (const std::vector<std::string>& streams : patterns) {
      const std::string text = tokenWith(strCat("t", tokens.size()), roles, streams);
      tokens.push_back({text, roles, StreamPatterns::parse(streams).value()});
    }
  }
  AccessControl access({.token_file = path_}, clock_);
  for (const Row& row : kMatrix) {
    for (const Token& token : tokens) {
      const bool is_allowed = row.for_nobody || std::ranges::any_of(token.roles, [&](Role role) {
                                return isInRow(row, role);
                              });
      const auto caller = access.admit(row.name, "peer", token.text);
      EXPECT_EQ(caller.status().code(),
                is_allowed ? absl::StatusCode::kOk : absl::StatusCode::kPermissionDenied)
          << row.name;
      if (!caller.ok() || row.for_nobody) continue;
      for (const char* stream : {"room.1", "room.2", "hall", "bedroom.1"}) {
        const bool is_matched = token.streams.matches(stream);
        EXPECT_EQ(caller->sees(stream), is_matched);
        EXPECT_EQ(caller->mayUse(stream).code(),
                  is_matched ? absl::StatusCode::kOk : absl::StatusCode::kPermissionDenied);
      }
    }
    for (const std::string& none : {std::string(), std::string("nonsense"), makeToken()}) {
      EXPECT_EQ(access.admit(row.name, "peer", none).status().code(),
                row.for_nobody ? absl::StatusCode::kOk : absl::StatusCode::kUnauthenticated)
          << row.name;
    }
    EXPECT_EQ(operationOf(row.name)->reach == Reach::kStream, row.needs_stream) << row.name;
  }
}

TEST_F(Matrix, grantsNobodyAnUnknownOperation) {
  const std::string token = tokenWith("all", allRights().roles, {"*"});
  AccessControl access({.token_file = path_}, clock_);
  EXPECT_EQ(access.admit("/other", "peer", token).status().code(),
            absl::StatusCode::kPermissionDenied);
  EXPECT_EQ(access.admit("/other", "peer", "").status().code(), absl::StatusCode::kUnauthenticated);
}

}  // namespace viewloom::operations_test
