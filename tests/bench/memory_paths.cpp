// SPDX-License-Identifier: Apache-2.0
// Cost of a load on this device by address, through a storage binding and as a texel: the figures
// behind shaders/lib/memory.glsl. Prints JSON; medians of interleaved runs.
#include <array>
#include <chrono>
#include <cstring>
#include <iostream>
#include <map>
#include <vector>

#include <nlohmann/json.hpp>

#include "gpu/compute_pass.h"
#include "gpu/submission.h"
#include "offline/median.h"
#include "shaders/memory_paths.h"
#include "shared/kernel_constants.h"

namespace viewloom {
namespace {

constexpr uint32_t kWordCount = 1u << 21;  // 16 MiB: about the structure of one 1080p layer
constexpr uint32_t kInvocationCount = 1u << 20;
constexpr uint32_t kLoadCount = 16;
constexpr int kRunCount = 7;
constexpr std::array kPaths = {"none", "address", "storage", "texels"};

struct Push {
  uint64_t words;
  uint32_t word_count;
  uint32_t load_count;
};

ComputePass makePass(const Device& device, uint32_t path) {
  const KernelConstant constant{abi::kIdFree, path};
  static constexpr DescriptorSlot kSlots[] = {
      {0, DescriptorKind::kStorage}, {1, DescriptorKind::kTexels}, {2, DescriptorKind::kStorage}};
  return ComputePass(device, {.spirv = memory_paths_spirv,
                              .push_bytes = sizeof(Push),
                              .constants = {&constant, 1},
                              .descriptors = kSlots,
                              .debug_name = "memory path"});
}

nlohmann::json measure(const Device& device) {
  const Buffer words(
      device,
      {.size_bytes = kWordCount * 8ull, .intent = MemoryIntent::kUpload, .debug_name = "words"});
  for (uint32_t i = 0; i < kWordCount; ++i) {
    const uint32_t word[] = {i * 2654435761u >> 7, i};
    std::memcpy(words.mapped().data() + i * 8ull, word, sizeof word);
  }
  const Buffer sums(device, {.size_bytes = kInvocationCount * 4ull, .debug_name = "sums"});
  const TexelView texels(device, words, TexelFormat::kRg32Uint);
  const Descriptor descriptors[] = {
      {.binding = 0, .buffer = &words, .size_bytes = words.sizeBytes()},
      {.binding = 1, .kind = DescriptorKind::kTexels, .texels = &texels},
      {.binding = 2, .buffer = &sums, .size_bytes = sums.sizeBytes()}};

  std::vector<ComputePass> passes;
  for (uint32_t path = 0; path < kPaths.size(); ++path) passes.push_back(makePass(device, path));
  std::array<std::vector<double>, kPaths.size()> ns_per_load;
  Timeline timeline(device);
  CommandRecorder recorder(device);
  for (int run = 0; run <= kRunCount; ++run) {
    for (size_t path = 0; path < kPaths.size(); ++path) {
      const Commands commands = recorder.begin();
      passes[path].recordDescriptors(commands, descriptors);
      passes[path].record(commands, Push{words.address(), kWordCount, kLoadCount},
                          kInvocationCount / 64);
      const auto start = std::chrono::steady_clock::now();
      timeline.wait(recorder.submit(timeline));
      const std::chrono::duration<double, std::nano> taken =
          std::chrono::steady_clock::now() - start;
      if (run == 0) continue;  // compiles
      ns_per_load[path].push_back(taken.count() / kInvocationCount / kLoadCount);
    }
  }
  nlohmann::json result{{"device", device.info().name}, {"ns_per_8_byte_load", {}}};
  for (size_t path = 0; path < kPaths.size(); ++path) {
    result["ns_per_8_byte_load"][kPaths[path]] = medianOf(ns_per_load[path]);
  }
  return result;
}

}  // namespace
}  // namespace viewloom

int main() {
  const viewloom::Device device({});
  std::cout << viewloom::measure(device).dump(2) << "\n";
  return 0;
}
