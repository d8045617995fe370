// SPDX-License-Identifier: Apache-2.0
#include "access/rights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "access/rights_json.h"

namespace viewloom::rights_test {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

struct PatternCase {
  const char* pattern;
  const char* stream;
  bool is_matched;
};

TEST(StreamPatterns, matchWholeNames) {
  const PatternCase cases[] = {
      {"*", "demo", true},          {"*", "", true},
      {"demo", "demo", true},       {"demo", "demo2", false},
      {"demo", "Demo", false},      {"room.*", "room.1", true},
      {"room.*", "room.", true},    {"room.*", "room", false},
      {"room.*", "room.1.2", true}, {"room.*", "bedroom.1", false},
      {"*.left", "a.left", true},   {"*.left", "a.left.b", false},
      {"a*b*c", "aXbYc", true},     {"a*b*c", "abcbc", true},
      {"a*b*c", "abcb", false},     {"**", "x", true},
      {"a.b", "aXb", false},  // '.' stands for itself
  };
  for (const PatternCase& c : cases) {
    const auto patterns = StreamPatterns::parse({c.pattern});
    ASSERT_TRUE(patterns.ok()) << c.pattern;
    EXPECT_EQ(patterns->matches(c.stream), c.is_matched) << c.pattern << " " << c.stream;
  }
}

TEST(StreamPatterns, matchNothingWithoutAPattern) {
  EXPECT_FALSE(StreamPatterns().matches("demo"));
  EXPECT_FALSE(StreamPatterns().matches(""));
}

TEST(StreamPatterns, areRefusedWithOtherCharacters) {
  for (const std::string& pattern :
       {std::string(), std::string("a/b"), std::string("a b"), std::string("[ab]"),
        std::string("a?"), std::string(65, 'a'), std::string("a\n"), std::string("\xff")}) {
    EXPECT_EQ(StreamPatterns::parse({pattern}).status().code(), absl::StatusCode::kInvalidArgument);
  }
  EXPECT_FALSE(StreamPatterns::parse(std::vector<std::string>(33, "a")).ok());
}

TEST(StreamPatterns, takeLittleTimeForManyStars) {
  std::string pattern;
  for (int i = 0; i < 32; ++i) pattern += "*a";
  EXPECT_FALSE(StreamPatterns::parse({pattern})->matches(std::string(64, 'a') + "b"));
}

TEST(Rights, areReadFromJson) {
  const auto rights = rightsFromJson(json::parse(
      R"({"roles": ["watch", "publish", "watch"], "streams": ["room.*"], "other": 1,
          "limits": {"displays": 4, "bytes_per_s": 1000000}})"));
  ASSERT_TRUE(rights.ok()) << rights.status();
  EXPECT_THAT(rights->roles, ElementsAre(Role::kPublish, Role::kWatch));
  EXPECT_TRUE(rights->streams.matches("room.1"));
  EXPECT_EQ(rights->quota.displays, 4U);
  EXPECT_EQ(rights->quota.bytes_per_s, 1'000'000U);
  EXPECT_FALSE(rights->quota.connections);
}

TEST(Rights, areTheSameAfterJson) {
  Rights rights = allRights();
  rights.quota.pixels_per_s = 7;
  nlohmann::ordered_json object;
  addRights(rights, object);
  EXPECT_EQ(*rightsFromJson(json::parse(object.dump())), rights);
}

TEST(Rights, nameTheWrongField) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({"streams": "*"})", "roles: is missing"},
      {R"({"roles": [], "streams": "*"})", "roles: there is none"},
      {R"({"roles": "wach", "streams": "*"})", "did you mean \"watch\"?"},
      {R"({"roles": [1], "streams": "*"})", "roles: is no list of texts"},
      {R"({"roles": "watch"})", "streams: is missing"},
      {R"({"roles": "watch", "streams": "a b"})", "streams: the pattern is \"a b\""},
      {R"({"roles": "watch", "streams": "*", "limits": 1})", "limits: is no object"},
      {R"({"roles": "watch", "streams": "*", "limits": {"display": 1}})", "\"displays\"?"},
      {R"({"roles": "watch", "streams": "*", "limits": {"displays": -1}})",
       "limits.displays: is no"},
      {R"({"roles": "watch", "streams": "*", "limits": {"displays": 1.5}})",
       "limits.displays: is no"},
  };
  for (const auto& [text, problem] : cases) {
    EXPECT_THAT(std::string(rightsFromJson(json::parse(text)).status().message()),
                HasSubstr(problem));
  }
}

}  // namespace viewloom::rights_test
