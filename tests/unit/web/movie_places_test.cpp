// SPDX-License-Identifier: Apache-2.0
#include "web/movie_places.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace viewloom::movie_places_test {
namespace {

std::function<void()> counting(int& count) {
  return [&count] { ++count; };
}

TEST(MoviePlaces, givesOutSoManyAndTakesThemBack) {
  MoviePlaces places(2);
  int left_count = 0;
  MoviePlaces::PlacePtr first = places.take("10.0.0.1", counting(left_count));
  const MoviePlaces::PlacePtr second = places.take("10.0.0.2", counting(left_count));
  EXPECT_NE(first, nullptr);
  EXPECT_NE(second, nullptr);
  EXPECT_EQ(places.take("10.0.0.1", counting(left_count)), nullptr);
  EXPECT_EQ(places.take("10.0.0.3", counting(left_count)), nullptr) << "nobody has two";
  first = nullptr;
  EXPECT_NE(places.take("10.0.0.3", counting(left_count)), nullptr);
  EXPECT_EQ(left_count, 0);
}

TEST(MoviePlaces, takesFromWhoeverHasTheMost) {
  MoviePlaces places(4);
  int greedy_left = 0;
  int newest_left = 0;
  const auto first = places.take("greedy", counting(greedy_left));
  const auto second = places.take("greedy", counting(greedy_left));
  const auto third = places.take("greedy", counting(greedy_left));
  auto newest = places.take("greedy", counting(newest_left));
  int modest_left = 0;
  const auto modest = places.take("modest", counting(modest_left));
  EXPECT_NE(modest, nullptr);
  EXPECT_EQ(newest_left, 1);
  newest = nullptr;  // has no place any more
  const auto another = places.take("modest", counting(modest_left));
  EXPECT_NE(another, nullptr);
  EXPECT_EQ(greedy_left, 1);
  EXPECT_EQ(places.take("modest", counting(modest_left)), nullptr) << "two for each";
  EXPECT_EQ(places.take("greedy", counting(modest_left)), nullptr);
  EXPECT_EQ(modest_left, 0);
}

TEST(MoviePlaces, mayBeNone) {
  int left_count = 0;
  EXPECT_EQ(MoviePlaces(0).take("10.0.0.1", counting(left_count)), nullptr);
}

TEST(MoviePlaces, endBeforeTheirPlaces) {
  int left_count = 0;
  MoviePlaces::PlacePtr place;
  {
    MoviePlaces places(1);
    place = places.take("10.0.0.1", counting(left_count));
  }
  place = nullptr;
  EXPECT_EQ(left_count, 0);
}

}  // namespace
}  // namespace viewloom::movie_places_test
