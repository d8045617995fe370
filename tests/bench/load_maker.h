// SPDX-License-Identifier: Apache-2.0
// Makes loads from frames and views. viewloom's own build says what is nearest and what counts as
// connected, so that every contestant means the same surfaces.
#pragma once

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
  explicit LoadMaker(const Device& device) : device_(device) {}

  BenchLoad make(std::string name, FramePtr frame, const ViewsOf& views_of) const;

 private:
  const Device& device_;
};

}  // namespace viewloom::bench
