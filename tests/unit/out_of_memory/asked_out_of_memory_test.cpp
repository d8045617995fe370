// SPDX-License-Identifier: Apache-2.0
// Pictures that wait for a frame go on without memory for it: on that thread no exception may come.
#include "pipeline/asked_pictures.h"

#include <gtest/gtest.h>

#include <string>

#include "support/failing_allocations.h"

namespace viewloom::asked_out_of_memory_test {
namespace {

TEST(AskedOutOfMemory, waitNoLongerAllTheSame) {
  // A list of so many is an allocation that may fail.
  constexpr size_t kPictures = test::kMayFail_bytes / sizeof(std::string);
  AskedPictures asked;
  for (size_t i = 0; i < kPictures; ++i) asked.add("room", "picture " + std::to_string(i));
  asked.add("roof", "another");
  test::failAllocation(0);
  const AskedPictures::Keys taken = asked.takeAll("room");
  EXPECT_FALSE(test::stopFailing()) << "pictures that were taken took memory";
  EXPECT_EQ(taken.size(), kPictures);
  EXPECT_TRUE(asked.takeAll("room").empty());
  EXPECT_EQ(asked.takeAll("roof").size(), 1u);
}

}  // namespace
}  // namespace viewloom::asked_out_of_memory_test
