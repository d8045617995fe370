// SPDX-License-Identifier: Apache-2.0
#include "cli/first_look.h"

#include "base/str_cat.h"
#include "cli/inspection_report.h"
#include "cli/option_trial.h"

namespace viewloom::cli {
namespace {

constexpr std::chrono::seconds kLookInterval{10};

}  // namespace

std::vector<FirstLook::Warning> FirstLook::look(const FrameFiles& files,
                                                const files::LoadedFrame& frame,
                                                const LoaderOptions& options) {
  std::vector<Warning> warnings;
  auto sources = inspect::inspectFrame(frame);
  if (!sources.ok()) return warnings;  // the server says why it refuses the frame
  tryRemedies(OptionTrial(files, options), *sources);
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
  looking_ = std::async(std::launch::async,
                        [files, frame, options = options_] { return look(files, frame, options); });
}

void FirstLook::takeWarnings(std::vector<std::string>& notes) {
  if (!looking_.valid()) return;
  if (looking_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  finish(notes);
}

void FirstLook::finish(std::vector<std::string>& notes) {
  if (!looking_.valid()) return;
  for (const Warning& warning : looking_.get()) {
    if (said_.insert(warning.kind).second) notes.push_back(warning.text);
  }
}

}  // namespace viewloom::cli
