// SPDX-License-Identifier: Apache-2.0
#include "cli/first_look.h"

#include <sys/resource.h>
#include <unistd.h>

#include "base/str_cat.h"
#include "cli/inspection_report.h"
#include "cli/interrupt.h"
#include "cli/option_trial.h"

namespace viewloom::cli {
namespace {

constexpr std::chrono::seconds kLookInterval{10};
constexpr int kNiceness = 10;
constexpr std::chrono::milliseconds kTick{20};  // how soon Ctrl-C is seen

}  // namespace

std::vector<FirstLook::Warning> FirstLook::look(const FrameFiles& files,
                                                const files::LoadedFrame& frame,
                                                const LoaderOptions& options,
                                                const std::stop_token& stop) {
  // Its thread alone: where the server renders on the same cores, the first picture comes first.
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);
  std::vector<Warning> warnings;
  auto sources = inspect::inspectFrame(frame, stop);
  if (!sources.ok()) return warnings;  // the server says why it refuses the frame
  tryRemedies(OptionTrial(files, options, stop), *sources);
  if (stop.stop_requested()) return warnings;
  for (const inspect::SourceInspection& source : *sources) {
    for (const inspect::LayerInspection& layer : source.layers) {
      for (const inspect::Suspicion& suspicion : layer.suspicions) {
        warnings.push_back(
            {suspicion.kind, strCat(files.name(), ": warning: ", warningText(suspicion))});
      }
    }
  }
  return warnings;
}

void FirstLook::offer(const FrameFiles& files, const files::LoadedFrame& frame) {
  const auto now = std::chrono::steady_clock::now();
  if (looking_.valid() || (looked_at_ && now - *looked_at_ < kLookInterval)) return;
  looked_at_ = now;
  // The bytes of planes are shared, not copied.
  looking_ =
      std::async(std::launch::async, [files, frame, options = options_, stop = stop_.get_token()] {
        return look(files, frame, options, stop);
      });
}

void FirstLook::takeWarnings(std::vector<std::string>& notes) {
  if (!looking_.valid()) return;
  if (looking_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  finish(notes);
}

void FirstLook::finish(std::vector<std::string>& notes) {
  if (!looking_.valid()) return;
  while (looking_.wait_for(kTick) != std::future_status::ready) {
    if (isInterrupted()) stop_.request_stop();
  }
  for (const Warning& warning : looking_.get()) {
    if (said_.insert(warning.kind).second) notes.push_back(warning.text);
  }
}

}  // namespace viewloom::cli
