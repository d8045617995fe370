// SPDX-License-Identifier: Apache-2.0
// viewloom itself, as the server runs it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "bench/contestant.h"
#include "bench/visit_counter.h"
#include "gpu/submission.h"
#include "structure/structure_builder.h"
#include "sweep/sweep_source.h"
#include "sweep/view_sweeper.h"
#include "trace/view_tracer.h"

namespace viewloom::bench {

class ViewloomContestant : public Contestant {
 public:
  // Traces like the server; can_sweep false: the walk beside it, where the server sweeps. The
  // device must outlive it.
  ViewloomContestant(const Device& device, bool can_sweep);

  std::string_view name() const override { return can_sweep_ ? "viewloom" : "walk"; }
  bool takes(const BenchLoad& load) const override { return can_sweep_ || isSwept(load); }
  // Whether the server would sweep it.
  bool isSwept(const BenchLoad& load) const;
  void prepare(const BenchLoad& load) override;
  void build() override;
  void trace() override;
  Picture picture() override;

  // Visits of the prepared load; it is walked.
  Visits visits();

 private:
  // The load's display, when it is swept.
  struct Sweep {
    SweepPlan plan;
    SweepSource source;
    std::vector<ViewSweeper> sweepers;  // [worker]
    SweptAtlas atlas;
  };

  void sweep(const TraceOutputs& outputs);
  // Traces the whole atlas; hears each band when it is done.
  void traceBands(const TraceOutputs& outputs,
                  const std::function<void(const TraceSlot& band, BandRows rows)>& on_band);

  const Device& device_;
  const bool can_sweep_;
  Timeline timeline_;
  CommandRecorder recorder_;
  StructureBuilder builder_;
  ViewTracer tracer_;
  const BenchLoad* load_ = nullptr;
  WorkerPool workers_;
  std::optional<Sweep> sweep_;
  std::unique_ptr<StructureSlot> structure_;
  std::vector<std::unique_ptr<TraceSlot>> bands_;  // of the whole atlas, from the top
};

}  // namespace viewloom::bench
