// SPDX-License-Identifier: Apache-2.0
#include "walk/part_meter.h"

#include <utility>

namespace viewloom {

void PartMeter::note(uint64_t value, std::function<void(int64_t measured_ns)> then) {
  watch_.whenDone(value, [this, submitted_ns = wallTimeNs(), then = std::move(then)] {
    then(clock_.noteDone(submitted_ns));
  });
  timeline_.wait(std::exchange(last_value_, value));
}

}  // namespace viewloom
