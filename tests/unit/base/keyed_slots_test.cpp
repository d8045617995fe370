// SPDX-License-Identifier: Apache-2.0
#include "base/keyed_slots.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace viewloom::keyed_slots_test {
namespace {

class KeyedSlotsTest : public testing::Test {
 protected:
  std::shared_ptr<int> take(const std::string& key) {
    return slots_.take(
        key, [](const int&) { return true; },
        [this] {
          ++made_count_;
          return std::make_unique<int>(0);
        });
  }

  int made_count_ = 0;
  int return_count_ = 0;
  KeyedSlots<int> slots_{2, [this] { ++return_count_; }};
};

TEST_F(KeyedSlotsTest, giveOneToEverybody) {
  const auto first = take("first");
  const auto again = take("first");
  EXPECT_TRUE(again);
  EXPECT_FALSE(take("first")) << "two are lent";
  const auto second = take("second");
  const auto third = take("third");
  EXPECT_TRUE(second && third);
  EXPECT_FALSE(take("third"));
}

TEST_F(KeyedSlotsTest, lendWhatCameBack) {
  take("first").reset();
  EXPECT_EQ(return_count_, 1);
  EXPECT_TRUE(take("second"));
  EXPECT_EQ(made_count_, 1);
}

TEST_F(KeyedSlotsTest, freeWhatIsNoLongerNeeded) {
  {
    const auto first = take("first");
    const auto second = take("second");
    const auto third = take("third");
    EXPECT_EQ(made_count_, 3);
  }
  const auto first = take("first");
  const auto second = take("second");
  EXPECT_EQ(made_count_, 3);
  EXPECT_TRUE(take("third"));
  EXPECT_EQ(made_count_, 4) << "two of the three were kept";
}

TEST_F(KeyedSlotsTest, passOneOnToAnother) {
  const auto slot = take("first");
  EXPECT_TRUE(slots_.passOn(slot, "second"));
  const auto of_first = take("first");
  const auto of_third = take("third");
  ASSERT_TRUE(of_first && of_third);
  EXPECT_FALSE(take("second")) << "it holds the one that was passed on";
  EXPECT_FALSE(slots_.passOn(slot, "third")) << "it holds one, and two others are lent";
  EXPECT_FALSE(take("second")) << "it still holds the one";
}

}  // namespace
}  // namespace viewloom::keyed_slots_test
