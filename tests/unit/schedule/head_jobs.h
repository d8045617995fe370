// SPDX-License-Identifier: Apache-2.0
// Jobs of heads that move, for a JobQueue.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "schedule/job_queue.h"
#include "schedule/resident_structure.h"

namespace viewloom {

inline constexpr int64_t kMs_ns = 1'000'000;
inline constexpr int64_t kSecond_ns = 1000 * kMs_ns;
inline constexpr int64_t kHeadset_ns = kSecond_ns / 90;

// All of one structure, and for nothing but eyes that have moved.
inline AtlasJob jobOf(const std::string& head, const PoseTimes& poses, int64_t deadline_ns) {
  static const auto structure = std::make_shared<const ResidentStructure>();
  return {.picture_key = head,
          .structure = structure,
          .deadline_ns = deadline_ns,
          .is_for_eyes = true,
          .is_tracked = true,
          .poses = poses};
}

}  // namespace viewloom
