// SPDX-License-Identifier: Apache-2.0
// The Vulkan device of a test program: validated, and silent unless a test is at fault.
#pragma once

#include <gtest/gtest.h>

#include "gpu/device.h"

namespace viewloom {

// Skips without a device, unless VIEWLOOM_REQUIRE_GPU is set.
class DeviceNeededTest : public testing::Test {
 protected:
  void SetUp() override;
};

// Fails on any validation message of warning or above that the test caused.
class GpuTest : public DeviceNeededTest {
 protected:
  void SetUp() override;
  void TearDown() override;
  // One per test program, with core and synchronization validation.
  static const Device& device();

  // One of its kind per test program, made for the device. Cases share what compiles kernels: on
  // lavapipe each such object compiles its own, which takes seconds.
  template <typename Made>
  static Made& shared() {
    static Made made(device());
    return made;
  }

 private:
  uint64_t messages_before_ = 0;
};

}  // namespace viewloom
