// SPDX-License-Identifier: Apache-2.0
#include "gpu/compute_pass.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/gpu_timer.h"
#include "gpu/submission.h"
#include "shaders/scale_floats.h"
#include "shared/kernel_constants.h"
#include "support/test_device.h"

namespace viewloom::compute_pass_test {
namespace {

struct ScalePush {
  uint64_t source = 0;
  uint64_t target = 0;
  uint32_t count = 0;
  uint32_t unused = 0;  // what C++ would pad; the shader does not read it
};

constexpr uint32_t kGroupSize = 64;

uint32_t groupCount(uint32_t count) {
  return (count + kGroupSize - 1) / kGroupSize;
}

std::span<float> floats(const Buffer& buffer) {
  return {reinterpret_cast<float*>(buffer.mapped().data()), buffer.sizeBytes() / sizeof(float)};
}

class ComputePassTest : public GpuTest {
 protected:
  ComputePass makeScalePass(std::vector<KernelConstant> factor_and_offset) {
    return {device(),
            {.spirv = scale_floats_spirv,
             .push_bytes = sizeof(ScalePush),
             .takes_parts = true,
             .constants = factor_and_offset,
             .debug_name = "scale floats"}};
  }
};

TEST_F(ComputePassTest, readsAndWritesMappedMemoryByAddress) {
  constexpr uint32_t kCount = 1000;  // not a multiple of the group size
  const Buffer source(device(), {.size_bytes = 4 * kCount, .intent = MemoryIntent::kUpload});
  const Buffer target(device(), {.size_bytes = 4 * kCount, .intent = MemoryIntent::kReadback});
  const ComputePass pass = makeScalePass({{abi::kIdFree, 3}, {abi::kIdFree + 1, 7}});
  std::iota(floats(source).begin(), floats(source).end(), 0.0f);

  Timeline timeline(device());
  CommandRecorder recorder(device());
  const Commands commands = recorder.begin();
  pass.record(commands, ScalePush{source.address(), target.address(), kCount}, groupCount(kCount));
  recordComputeToHost(commands);
  ASSERT_TRUE(timeline.wait(recorder.submit(timeline)));

  for (uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(floats(target)[i], 3.0f * float(i) + 7.0f) << i;
}

TEST_F(ComputePassTest, writesTheColumnsThatItIsGiven) {
  constexpr uint32_t kCount = 10 * kGroupSize;
  const Buffer source(device(), {.size_bytes = 4 * kCount, .intent = MemoryIntent::kUpload});
  const Buffer target(device(), {.size_bytes = 4 * kCount, .intent = MemoryIntent::kReadback});
  const ComputePass pass = makeScalePass({{abi::kIdFree, 3}, {abi::kIdFree + 1, 7}});
  std::iota(floats(source).begin(), floats(source).end(), 0.0f);
  std::ranges::fill(floats(target), -1.0f);

  Timeline timeline(device());
  CommandRecorder recorder(device());
  const Commands commands = recorder.begin();
  pass.recordColumns(commands, ScalePush{source.address(), target.address(), kCount}, {2, 5}, 1);
  recordComputeToHost(commands);
  ASSERT_TRUE(timeline.wait(recorder.submit(timeline)));

  for (uint32_t i = 0; i < kCount; ++i) {
    const bool is_given = i >= 2 * kGroupSize && i < 5 * kGroupSize;
    ASSERT_EQ(floats(target)[i], is_given ? 3.0f * float(i) + 7.0f : -1.0f) << i;
  }
}

// Groups that a buffer counts begin with the first, wherever those before them began.
TEST_F(ComputePassTest, beginsWithTheFirstGroupAfterColumns) {
  constexpr uint32_t kCount = 10 * kGroupSize;
  const Buffer source(device(), {.size_bytes = 4 * kCount, .intent = MemoryIntent::kUpload});
  const Buffer columns(device(), {.size_bytes = 4 * kCount, .intent = MemoryIntent::kReadback});
  const Buffer target(device(), {.size_bytes = 4 * kCount, .intent = MemoryIntent::kReadback});
  const Buffer groups(device(), {.size_bytes = 3 * sizeof(uint32_t)});
  const ComputePass pass = makeScalePass({{abi::kIdFree, 3}, {abi::kIdFree + 1, 7}});
  std::iota(floats(source).begin(), floats(source).end(), 0.0f);
  std::ranges::fill(floats(target), -1.0f);

  Timeline timeline(device());
  CommandRecorder recorder(device());
  const Commands commands = recorder.begin();
  constexpr std::array<uint32_t, 3> kGroups = {3, 1, 1};
  commands.write(groups, std::as_bytes(std::span(kGroups)));
  recordTransferToCompute(commands);
  pass.recordColumns(commands, ScalePush{source.address(), columns.address(), kCount}, {2, 5}, 1);
  pass.recordIndirect(commands, ScalePush{source.address(), target.address(), kCount}, groups, 0);
  recordComputeToHost(commands);
  ASSERT_TRUE(timeline.wait(recorder.submit(timeline)));

  for (uint32_t i = 0; i < kCount; ++i) {
    ASSERT_EQ(floats(target)[i], i < 3 * kGroupSize ? 3.0f * float(i) + 7.0f : -1.0f) << i;
  }
}

TEST_F(ComputePassTest, reachesPast128MiB) {
  constexpr uint64_t kBytes = 160ull << 20;
  const auto count = static_cast<uint32_t>(kBytes / sizeof(float));
  const Buffer source(device(), {.size_bytes = kBytes, .intent = MemoryIntent::kUpload});
  const Buffer target(device(), {.size_bytes = kBytes, .intent = MemoryIntent::kReadback});
  const ComputePass pass = makeScalePass({{abi::kIdFree, 2}, {abi::kIdFree + 1, 0}});
  floats(source).back() = 21.0f;

  Timeline timeline(device());
  CommandRecorder recorder(device());
  const Commands commands = recorder.begin();
  const uint32_t first = count - kGroupSize;  // the last group alone: its addresses are what counts
  pass.record(
      commands,
      ScalePush{source.address() + 4ull * first, target.address() + 4ull * first, kGroupSize}, 1);
  recordComputeToHost(commands);
  ASSERT_TRUE(timeline.wait(recorder.submit(timeline)));
  EXPECT_EQ(floats(target).back(), 42.0f);
}

TEST_F(ComputePassTest, chainsPassesAndTransfersThroughBarriers) {
  constexpr uint32_t kCount = 256;
  constexpr uint64_t kBytes = 4 * kCount;
  const Buffer source(device(), {.size_bytes = kBytes, .intent = MemoryIntent::kUpload});
  const Buffer middle(device(), {.size_bytes = kBytes, .debug_name = "middle"});
  const Buffer target(device(), {.size_bytes = kBytes, .intent = MemoryIntent::kReadback});
  const ComputePass times_two = makeScalePass({{abi::kIdFree, 2}, {abi::kIdFree + 1, 0}});
  std::iota(floats(source).begin(), floats(source).end(), 0.0f);

  Timeline timeline(device());
  CommandRecorder recorder(device());
  const Commands commands = recorder.begin();
  const CopiedBytes whole{.size_bytes = kBytes};
  commands.copy(source, middle, whole);
  recordTransferToCompute(commands);
  const ScalePush in_place{middle.address(), middle.address(), kCount};
  times_two.record(commands, in_place, groupCount(kCount));
  recordComputeBarrier(commands);
  times_two.record(commands, in_place, groupCount(kCount));
  recordComputeToTransfer(commands);
  commands.copy(middle, target, whole);
  recordTransferToHost(commands);
  ASSERT_TRUE(timeline.wait(recorder.submit(timeline)));

  for (uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(floats(target)[i], 4.0f * float(i)) << i;
}

TEST_F(ComputePassTest, timesEachNamedPass) {
  if (device().timestampPeriodNs() <= 0) GTEST_SKIP() << "the device has no timestamps";
  const Buffer buffer(device(), {.size_bytes = 256});
  const ComputePass pass = makeScalePass({{abi::kIdFree, 1}, {abi::kIdFree + 1, 1}});
  const ScalePush push{buffer.address(), buffer.address(), 64};
  GpuTimer timer(device(), 2);
  Timeline timeline(device());
  CommandRecorder recorder(device());
  const Commands commands = recorder.begin();
  timer.recordReset(commands);
  for (const char* name : {"first", "second", "one too many"}) {
    timer.recordBegin(commands, name);
    pass.record(commands, push, 1);
    recordComputeBarrier(commands);
    timer.recordEnd(commands);
  }
  ASSERT_TRUE(timeline.wait(recorder.submit(timeline)));
  const auto times = timer.results();
  ASSERT_EQ(times.size(), 2u);
  EXPECT_STREQ(times[0].name, "first");
  EXPECT_STREQ(times[1].name, "second");
  for (const GpuPassTime& time : times) EXPECT_GE(time.duration_ns, 0);
}

TEST_F(ComputePassTest, reportsTimelineValuesInOrder) {
  Timeline timeline(device());
  CommandRecorder recorder(device());
  EXPECT_EQ(timeline.completedValue(), 0u);
  for (uint64_t expected = 1; expected <= 3; ++expected) {
    recorder.begin();
    EXPECT_EQ(recorder.submit(timeline), expected);
    ASSERT_TRUE(timeline.wait(expected));
    EXPECT_GE(timeline.completedValue(), expected);
  }
  EXPECT_FALSE(timeline.wait(4, 1'000'000)) << "nothing signals 4";
}

// A kernel that is given a constant of another one would answer wrongly, and so would one that
// lacks one of its own.
TEST_F(ComputePassTest, takesExactlyTheConstantsOfTheKernel) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_DEATH(makeScalePass({{abi::kIdFree, 1}, {abi::kIdFree + 2, 1}}), "check failed");
  EXPECT_DEATH(makeScalePass({{abi::kIdFree, 1}}), "check failed");
}

}  // namespace
}  // namespace viewloom::compute_pass_test
