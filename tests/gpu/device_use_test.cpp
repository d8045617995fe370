// SPDX-License-Identifier: Apache-2.0
// When work that nobody waits for may have a device.
#include "walk/device_use.h"

#include <gtest/gtest.h>

namespace viewloom::device_use_test {
namespace {

constexpr int64_t kNow_ns = 5'000'000'000;
constexpr int64_t kMs_ns = 1'000'000;

TEST(DeviceUse, asksNoRestOfADeviceThatNobodyHasNeeded) {
  const DeviceUse use;
  EXPECT_EQ(use.restNs(0), 0);
  EXPECT_EQ(use.restNs(kNow_ns), 0);
}

TEST(DeviceUse, asksForRestUntilNobodyHasNeededItForAWhile) {
  DeviceUse use;
  use.note(kNow_ns);
  EXPECT_EQ(use.restNs(kNow_ns), DeviceUse::kRest_ns);
  EXPECT_EQ(use.restNs(kNow_ns + 500 * kMs_ns), DeviceUse::kRest_ns - 500 * kMs_ns);
  use.note(kNow_ns + 600 * kMs_ns);
  EXPECT_EQ(use.restNs(kNow_ns + DeviceUse::kRest_ns), 600 * kMs_ns);
  EXPECT_EQ(use.restNs(kNow_ns + DeviceUse::kRest_ns + 600 * kMs_ns), 0);
}

TEST(DeviceUse, asksForRestHoweverLongAUseLasts) {
  DeviceUse use;
  use.begin();
  use.begin();
  const int64_t later_ns = kNow_ns + 100 * DeviceUse::kRest_ns;
  EXPECT_EQ(use.restNs(later_ns), DeviceUse::kRest_ns);
  use.end(later_ns);
  EXPECT_EQ(use.restNs(later_ns + 2 * DeviceUse::kRest_ns), DeviceUse::kRest_ns) << "one goes on";
  use.end(later_ns + 2 * DeviceUse::kRest_ns);
  EXPECT_EQ(use.restNs(later_ns + 2 * DeviceUse::kRest_ns), DeviceUse::kRest_ns) << "just over";
  EXPECT_EQ(use.restNs(later_ns + 3 * DeviceUse::kRest_ns), 0);
}

}  // namespace
}  // namespace viewloom::device_use_test
