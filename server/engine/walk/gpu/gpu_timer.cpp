// SPDX-License-Identifier: Apache-2.0
#include "gpu/gpu_timer.h"

#include "gpu/vulkan.h"

namespace viewloom {

GpuTimer::GpuTimer(const Device& device, uint32_t pass_count_max)
    : period_ns_(device.timestampPeriodNs()), pass_count_max_(pass_count_max) {
  if (period_ns_ <= 0) return;
  const uint32_t bit_count = device.timestampValidBits();
  tick_mask_ = bit_count >= 64 ? ~uint64_t{0} : (uint64_t{1} << bit_count) - 1;
  pool_ = hide(vk::raii::QueryPool(
      device.handle(), {.queryType = vk::QueryType::eTimestamp, .queryCount = 2 * pass_count_max}));
  passes_.reserve(pass_count_max);
  ticks_.resize(2 * size_t{pass_count_max});
}

void GpuTimer::recordReset(Commands commands) {
  if (period_ns_ <= 0) return;
  passes_.clear();
  query_count_ = 0;
  vk::CommandBuffer(commands.handle()).resetQueryPool(**pool_, 0, 2 * pass_count_max_);
}

void GpuTimer::recordBegin(Commands commands, const char* name) {
  if (period_ns_ <= 0 || passes_.size() == pass_count_max_) return;
  passes_.push_back({.name = name});
  vk::CommandBuffer(commands.handle())
      .writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, **pool_, query_count_++);
}

void GpuTimer::recordEnd(Commands commands) {
  if (query_count_ == 2 * passes_.size()) return;  // the pass began untimed
  vk::CommandBuffer(commands.handle())
      .writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, **pool_, query_count_++);
}

std::span<const GpuPassTime> GpuTimer::results() {
  if (query_count_ == 0) return {};
  const auto result =
      vk::Device(pool_->getDevice())
          .getQueryPoolResults(**pool_, 0, query_count_, query_count_ * sizeof(uint64_t),
                               ticks_.data(), sizeof(uint64_t),
                               vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
  if (result != vk::Result::eSuccess) return {};
  for (size_t i = 0; i < passes_.size(); ++i) {
    const uint64_t ticks = (ticks_[2 * i + 1] - ticks_[2 * i]) & tick_mask_;
    passes_[i].duration_ns = static_cast<int64_t>(static_cast<double>(ticks) * period_ns_);
  }
  return passes_;
}

}  // namespace viewloom
