// SPDX-License-Identifier: Apache-2.0
#include "structure/mean_color.h"

#include <algorithm>

namespace viewloom {

MeanColor::Planes& MeanColor::planesFor(const ColorReach& reach) {
  const auto of_reach = std::find_if(planes_.begin(), planes_.end(),
                                     [&](const auto& planes) { return planes->reach == reach; });
  if (of_reach != planes_.end()) {
    std::rotate(planes_.begin(), of_reach, of_reach + 1);
    return *planes_.front();
  }
  const auto free = std::find_if(planes_.begin(), planes_.end(),
                                 [](const auto& planes) { return planes->made_row_count == 0; });
  if (free == planes_.end() && planes_.size() < kReachesMax) {
    planes_.insert(planes_.begin(),
                   std::make_unique<Planes>(
                       Planes{.reach = reach, .means = LayeredBuffer(device_, options_)}));
    return *planes_.front();
  }
  const auto taken = free == planes_.end() ? planes_.end() - 1 : free;
  std::rotate(planes_.begin(), taken, taken + 1);
  planes_.front()->reach = reach;
  planes_.front()->made_row_count = 0;
  return *planes_.front();
}

void MeanColor::forget() {
  for (const auto& planes : planes_) planes->made_row_count = 0;
}

}  // namespace viewloom
