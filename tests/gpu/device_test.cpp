// SPDX-License-Identifier: Apache-2.0
#include "gpu/device.h"

#include <gmock/gmock.h>

#include "gpu/buffer.h"
#include "gpu/device_error.h"
#include "gpu/vulkan.h"
#include "support/test_device.h"

namespace viewloom::device_test {
namespace {

using testing::HasSubstr;

std::string startupError(const DeviceOptions& options) {
  try {
    const Device device(options);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

using DeviceTest = GpuTest;

TEST_F(DeviceTest, listsTheDeviceItChooses) {
  const DeviceInfo& chosen = device().info();
  const auto listed = Device::listDevices();
  ASSERT_LT(chosen.index, listed.size());
  EXPECT_EQ(listed[chosen.index].name, chosen.name);
  EXPECT_TRUE(chosen.missing_features.empty());
  EXPECT_GT(chosen.limits.allocation_bytes_max, 0u);
}

TEST_F(DeviceTest, isFoundByIndexAndByPartOfItsNameInAnyCase) {
  const DeviceInfo& chosen = device().info();
  const std::string part = chosen.name.substr(0, 4);
  EXPECT_EQ(Device({.select = std::to_string(chosen.index)}).info().name, chosen.name);
  std::string upper = part;
  for (char& letter : upper) letter = static_cast<char>(std::toupper(letter));
  EXPECT_THAT(Device({.select = upper}).info().name, HasSubstr(part));
}

TEST_F(DeviceTest, namesTheDevicesThereAreWhenNoneMatches) {
  const std::string error = startupError({.select = "no such device"});
  EXPECT_THAT(error, HasSubstr("no such device"));
  EXPECT_THAT(error, HasSubstr(device().info().name));
}

TEST_F(DeviceTest, countsWhatValidationFinds) {
  const Device validated({.select = "", .validation = true});
  EXPECT_EQ(validated.validationLog().messageCount(), 0u);
  const vk::BufferCreateInfo empty{.size = 0, .usage = vk::BufferUsageFlagBits::eStorageBuffer};
  const vk::raii::Buffer buffer(validated.handle(), empty);
  EXPECT_GE(validated.validationLog().messageCount(), 1u);
}

TEST_F(DeviceTest, refusesABufferTheDeviceCannotHoldByName) {
  const uint64_t too_large = device().info().limits.allocation_bytes_max + 4;
  try {
    const Buffer buffer(device(), {.size_bytes = too_large, .debug_name = "huge"});
    FAIL() << "allocated " << too_large << " bytes";
  } catch (const std::exception& error) {
    EXPECT_TRUE(isOutOfDeviceMemory(error));
    EXPECT_THAT(error.what(), HasSubstr("huge"));
  }
}

TEST_F(DeviceTest, countsEachGpuAllocation) {
  const uint64_t before = gpuAllocationCount();
  Buffer first(device(), {.size_bytes = 16});
  const Buffer second(device(), {.size_bytes = 16, .intent = MemoryIntent::kUpload});
  const Buffer moved = std::move(first);
  EXPECT_EQ(gpuAllocationCount(), before + 2);
  EXPECT_NE(moved.address(), second.address());
}

TEST_F(DeviceTest, knowsWhatItsBuffersHold) {
  const uint64_t before_bytes = gpuMemoryBytes();
  {
    Buffer buffer(device(), {.size_bytes = 1000});
    EXPECT_GE(gpuMemoryBytes(), before_bytes + 1000);
    const uint64_t one_bytes = gpuMemoryBytes();
    const Buffer moved = std::move(buffer);
    EXPECT_EQ(gpuMemoryBytes(), one_bytes);
    buffer = Buffer(device(), {.size_bytes = 2000});
    EXPECT_GE(gpuMemoryBytes(), one_bytes + 2000);
    buffer = Buffer();
    EXPECT_EQ(gpuMemoryBytes(), one_bytes);
  }
  EXPECT_EQ(gpuMemoryBytes(), before_bytes);
}

}  // namespace
}  // namespace viewloom::device_test
