// SPDX-License-Identifier: Apache-2.0
#include "engine/engines.h"

#include <algorithm>

#include "base/check.h"

namespace viewloom {

size_t Engines::firstFor(const Frame& frame) const {
  const auto first =
      std::ranges::find_if(all, [&](const auto& engine) { return engine->takes(frame); });
  return size_t(first - all.begin());
}

uint64_t Engines::preparedBytes(const FrameFormat& format) const {
  for (const auto& engine : all) {
    if (const uint64_t bytes = engine->preparedBytes(format); bytes > 0) return bytes;
  }
  return 0;
}

StreamPreparers::StreamPreparers(const Engines& engines) {
  for (const auto& engine : engines.all) preparers_.push_back(engine->preparer());
}

FrameForms::FrameForms(StreamPreparers& preparers) : takes_(preparers.count()) {
  for (size_t engine = 0; engine < preparers.count(); ++engine) {
    forms_.push_back(preparers.of(engine).make());
    is_prepared_.push_back(std::make_unique<std::atomic<bool>>(false));
  }
}

void FrameForms::take(const FramePtr& frame, const Engines& engines) {
  first_ = engines.firstFor(*frame);
  VIEWLOOM_CHECK(first_ < forms_.size());
  for (size_t engine = 0; engine < forms_.size(); ++engine) {
    takes_[engine] = engines.all[engine]->takes(*frame);
    if (takes_[engine]) forms_[engine]->take(frame);
    *is_prepared_[engine] = false;
  }
  first().reserve();
}

int64_t FrameForms::prepare(size_t engine, const Clock& clock,
                            const PreparationEvents& events) const {
  const int64_t upload_ns = forms_[engine]->prepare(clock, events);
  *is_prepared_[engine] = true;
  return upload_ns;
}

}  // namespace viewloom
