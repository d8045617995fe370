// SPDX-License-Identifier: Apache-2.0
// Records a stage of a build between two time stamps.
#pragma once

#include "gpu/gpu_timer.h"
#include "structure/cut_recording.h"

namespace viewloom {

// Runs one stage between its time stamps.
class Timed {
 public:
  Timed(const CutRecording& recording, GpuTimer* timer, const char* name)
      : recording_(recording), timer_(timer) {
    if (timer_) timer_->recordBegin(recording_.commands(), name);
  }
  ~Timed() {
    if (timer_) timer_->recordEnd(recording_.commands());
  }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

 private:
  const CutRecording& recording_;
  GpuTimer* timer_;
};

// `record` records the stage; `timer`: nullptr = untimed.
template <typename Record>
void recordStage(const CutRecording& recording, GpuTimer* timer, const char* name,
                 Record&& record) {
  const Timed timed(recording, timer, name);
  record();
}

}  // namespace viewloom
