// SPDX-License-Identifier: Apache-2.0
#include "pipeline/gpu_loop.h"

#include <optional>
#include <stdexcept>
#include <utility>

#include "base/thread_name.h"

namespace viewloom {

GpuLoop::GpuLoop(const PipelineLinks& links, Timeline& timeline, const StructureBuilder& builder,
                 TraceLoop& traces, WakeUp& wake_up)
    : links_(links),
      timeline_(timeline),
      builder_(builder),
      traces_(traces),
      wake_up_(wake_up),
      thread_([this](const std::stop_token& stop) {
        nameThread("gpu");
        try {
          run(stop);
        } catch (const std::exception& error) {
          links_.on_failure(error);
        }
        end();
      }) {}

void GpuLoop::stop() {
  thread_.request_stop();
  wake_up_.ring();
  if (thread_.joinable()) thread_.join();
}

void GpuLoop::abandon() {
  is_abandoned_ = true;
  wake_up_.ring();
}

void GpuLoop::end() {
  std::lock_guard lock(mutex_);
  has_ended_ = true;
  builds_.clear();  // breaks their promises: who waits gets an exception
}

void GpuLoop::build(StructureBuild& build) {
  std::future<uint64_t> timeline_value;
  {
    std::lock_guard lock(mutex_);
    if (has_ended_) throw std::runtime_error("the GPU loop has ended");
    builds_.push_back({&build, {}});
    timeline_value = builds_.back().timeline_value.get_future();
  }
  wake_up_.ring();
  timeline_.wait(timeline_value.get());
}

void GpuLoop::run(const std::stop_token& stop) {
  while (!is_abandoned_) {
    if (submitBuild()) continue;
    const bool may_begin = !stop.stop_requested();
    if (traces_.submitPart(may_begin)) continue;
    if (!may_begin && !traces_.hasBegun()) return;
    if (const auto until_ns = traces_.waitsUntilNs(); until_ns && may_begin) {
      wake_up_.waitFor(links_.clock.napUntil(*until_ns));
    } else {
      wake_up_.wait();
    }
  }
}

bool GpuLoop::submitBuild() {
  std::optional<BuildRequest> request;
  {
    std::lock_guard lock(mutex_);
    if (builds_.empty()) return false;
    request = std::move(builds_.front());
    builds_.pop_front();
  }
  WalkedForm& form = *request->build->walked;
  try {
    form.structure.recordBuild(form.recorder.begin(), builder_);
    request->timeline_value.set_value(form.recorder.submit(timeline_));
  } catch (const std::exception&) {
    // Who waits may be the first to tell of it: let it be told what happened.
    request->timeline_value.set_exception(std::current_exception());
    throw;
  }
  return true;
}

}  // namespace viewloom
