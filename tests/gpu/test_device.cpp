// SPDX-License-Identifier: Apache-2.0
#include "gpu/test_device.h"

#include <cstdlib>

namespace viewloom {

const Device& GpuTest::device() {
  static const Device kDevice({.select = "", .validation = true});
  return kDevice;
}

void DeviceNeededTest::SetUp() {
  if (Device::listDevices().empty() && !std::getenv("VIEWLOOM_REQUIRE_GPU")) {
    GTEST_SKIP() << "no Vulkan device";
  }
}

void GpuTest::SetUp() {
  DeviceNeededTest::SetUp();
  if (IsSkipped()) return;
  messages_before_ = device().validationLog().messageCount();
}

void GpuTest::TearDown() {
  if (IsSkipped()) return;
  EXPECT_EQ(device().validationLog().messageCount(), messages_before_)
      << "the validation layers complain (see the log above)";
}

}  // namespace viewloom
