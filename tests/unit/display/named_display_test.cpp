// SPDX-License-Identifier: Apache-2.0
#include "display/named_display.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::named_display_test {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

TEST(NamedDisplay, isSuggestedWhateverTheKind) {
  const auto refusalOf = [](const DisplaySpec& spec) {
    return std::string(completeDisplaySpec(spec).status().message());
  };
  EXPECT_EQ(refusalOf({.kind = IntegralSpec{.preset = "near_eye_2031"}}),
            "integral.preset: there is no preset \"near_eye_2031\"; known presets: near_eye_2013; "
            "did you mean \"near_eye_2013\"?");
  EXPECT_EQ(refusalOf({.kind = RgbdSpec{.preset = "portrait"}}),
            "rgbd.preset: there is no preset \"portrait\"; known presets: wowvx, wowvx_declipse; "
            "\"portrait\" is a display of another kind: open it by its name alone");
  EXPECT_THAT(refusalOf({.kind = LenticularSpec{.preset = "near_eye"}}),
              EndsWith("; \"near_eye_2013\" is a display of another kind: open it by its name "
                       "alone"));
  EXPECT_THAT(refusalOf({.kind = QuiltSpec{.preset = "hologram"}}),
              AllOf(Not(HasSubstr("another kind")), Not(HasSubstr("did you mean"))));
}

TEST(NamedDisplay, isOfTheKindOfItsDevice) {
  EXPECT_TRUE(std::holds_alternative<QuiltSpec>(*namedDisplay("portrait")));
  EXPECT_TRUE(std::holds_alternative<IntegralSpec>(*namedDisplay("near_eye_2013")));
  EXPECT_TRUE(std::holds_alternative<RgbdSpec>(*namedDisplay("wowvx")));
  for (const std::string& name : displayNames()) {
    ASSERT_TRUE(namedDisplay(name).ok()) << name;
    EXPECT_TRUE(completeDisplaySpec({.kind = *namedDisplay(name)}).ok()) << name;
  }
  const absl::Status unknown = namedDisplay("wovwx").status();
  EXPECT_EQ(unknown.code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(fieldOf(unknown), "preset");
  EXPECT_THAT(std::string(unknown.message()), EndsWith("did you mean \"wowvx\"?"));
}

}  // namespace
}  // namespace viewloom::named_display_test
