// SPDX-License-Identifier: Apache-2.0
#include "gpu/sweep_under_test.h"

#include "base/check.h"

namespace viewloom {

std::vector<TracedView> SweepUnderTest::trace(const std::vector<oracle::OutputView>& views,
                                              double tolerance_px) {
  const TraceJob job = jobOf(views, tolerance_px, source_.camera(), source_.sizePx());
  const double inv_z_max = source_.measured().stats.inv_z_max;
  const std::optional<SweepPlan> plan = SweepPlan::make(job, inv_z_max);
  VIEWLOOM_CHECK(plan.has_value());
  const TraceOutputs outputs = {.linear = true, .records = true};
  SweptAtlas atlas;
  atlas.begin(job, outputs);
  RowSource source = source_.rowSource();
  source.planted_fault = planted_fault_;
  sweeper_.sweepRows({.job = &job, .plan = &*plan, .source = source, .inv_z_max = float(inv_z_max)},
                     0, plan->rowCount(), outputs, atlas);
  return splitByView(*job.layout, atlas.records, atlas.linear);
}

}  // namespace viewloom
