// SPDX-License-Identifier: Apache-2.0
#include "support/test_device.h"

#include <dlfcn.h>

#include <cstdlib>

// Leaks that the sanitizer excuses. The validation layer of Vulkan 1.3.239 leaves objects that hold
// one another when its device is destroyed; viewloomd without it leaks nothing.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libVkLayer_khronos_validation";
}

namespace viewloom {
namespace {

// Once unloaded the layer has no name in a stack, and nothing could be excused by it.
void keepValidationLayerLoaded() {
  dlopen("libVkLayer_khronos_validation.so", RTLD_NOW | RTLD_NODELETE);
}

}  // namespace

const Device& GpuTest::device() {
  static const Device kDevice({.select = "", .validation = true});
  return kDevice;
}

void DeviceNeededTest::SetUp() {
  if (Device::listDevices().empty() && !std::getenv("VIEWLOOM_REQUIRE_GPU")) {
    GTEST_SKIP() << "no Vulkan device";
  }
  keepValidationLayerLoaded();
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
