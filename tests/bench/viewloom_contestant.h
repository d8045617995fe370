// SPDX-License-Identifier: Apache-2.0
// viewloom's own build and walk, as the server runs them.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "bench/contestant.h"
#include "gpu/command_recorder.h"
#include "gpu/timeline.h"
#include "structure/structure_builder.h"
#include "trace/view_tracer.h"

namespace viewloom::bench {

struct Visits {
  double mean = 0;
  uint32_t p99 = 0;
  uint32_t max = 0;
};

class ViewloomContestant : public Contestant {
 public:
  // The device must outlive it.
  explicit ViewloomContestant(const Device& device);

  std::string_view name() const override { return "viewloom"; }
  bool takes(const BenchLoad&) const override { return true; }
  void prepare(const BenchLoad& load) override;
  void build() override;
  void trace() override;
  Picture picture() override;

  // Nodes and facets a ray looks at, of the prepared load.
  Visits visits();

 private:
  // Traces the whole atlas; hears each band when it is done.
  void traceBands(const TraceOutputs& outputs,
                  const std::function<void(const TraceSlot& band, BandRows rows)>& on_band);

  const Device& device_;
  Timeline timeline_;
  CommandRecorder recorder_;
  StructureBuilder builder_;
  ViewTracer tracer_;
  const BenchLoad* load_ = nullptr;
  std::unique_ptr<StructureSlot> structure_;
  std::vector<std::unique_ptr<TraceSlot>> bands_;  // of the whole atlas, from the top
};

}  // namespace viewloom::bench
