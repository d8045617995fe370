// SPDX-License-Identifier: Apache-2.0
#include "base/spell.h"

#include <gtest/gtest.h>

namespace viewloom::spell_test {
namespace {

TEST(SpellTest, lastsFromWhereItBeganUntilABreak) {
  Spell spell;
  EXPECT_EQ(spell.note(false, 10), 0);
  EXPECT_EQ(spell.note(true, 20), 0);
  EXPECT_EQ(spell.note(true, 50), 30);
  EXPECT_EQ(spell.note(false, 60), 0);
  EXPECT_EQ(spell.note(true, 70), 0);
  EXPECT_EQ(spell.note(true, 75), 5);
}

}  // namespace
}  // namespace viewloom::spell_test
