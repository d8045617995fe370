// SPDX-License-Identifier: Apache-2.0
#include "web/url.h"

#include <gtest/gtest.h>

namespace viewloom::url_test {
namespace {

TEST(Url, takesPathAndParametersApart) {
  const auto url = parseUrl("/still/a%20b+c.jpg?x=1+2&y=%26%3d&z&&w=#fragment");
  ASSERT_TRUE(url.ok()) << url.status();
  EXPECT_EQ(url->path, "/still/a b+c.jpg");
  EXPECT_EQ(url->parameters, (QueryParameters{{"x", "1 2"}, {"y", "&="}, {"z", ""}, {"w", ""}}));
}

TEST(Url, comesBackFromItsOwnQuery) {
  QueryParameters parameters;
  for (int byte = 0x20; byte < 0x7f; ++byte) {
    parameters.emplace(std::string(1, static_cast<char>(byte)), std::string("ä") + char(byte));
  }
  const auto url = parseUrl("/?" + queryString(parameters));
  ASSERT_TRUE(url.ok()) << url.status();
  EXPECT_EQ(url->parameters, parameters);
}

TEST(Url, refusesWhatCannotBeMeant) {
  for (const char* target : {"", "x", "*", "http://host/", "/%", "/%1", "/%1g", "/%-1", "/% 1",
                             "/%00", "/%7f", "/a?b=%0a", "/a?b=1&b=2"}) {
    const auto url = parseUrl(target);
    ASSERT_FALSE(url.ok()) << target;
    EXPECT_EQ(url.status().code(), absl::StatusCode::kInvalidArgument) << target;
    EXPECT_FALSE(fieldOf(url.status()).empty()) << target;
  }
}

}  // namespace
}  // namespace viewloom::url_test
