// SPDX-License-Identifier: Apache-2.0
// Makes loads from frames and views. viewloom's own build says what is nearest and what counts as
// connected, so that every contestant means the same surfaces.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "bench/bench_load.h"
#include "bench/bench_views.h"
#include "gpu/device.h"

namespace viewloom::bench {

using ViewsOf = std::function<AtlasLayout(const SourceView&)>;

// The device must outlive it. Thread-safety: none.
class LoadMaker {
 public:
  // `miniature`: scenes and tiles are so many times smaller on a side, to try the program out.
  explicit LoadMaker(const Device& device, uint32_t miniature = 1)
      : device_(device), miniature_(miniature) {}

  SizePx sceneSize(SizePx size_px) const {
    return {size_px.width / miniature_, size_px.height / miniature_};
  }
  BenchLoad make(std::string name, FramePtr frame, const ViewsOf& views_of) const;

 private:
  const Device& device_;
  const uint32_t miniature_;
};

}  // namespace viewloom::bench
