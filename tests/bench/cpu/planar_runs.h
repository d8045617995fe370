// SPDX-License-Identifier: Apache-2.0
// The rival "runs": a scan converter of planar runs of samples.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "bench/cpu/row_contestant.h"

namespace viewloom::bench {

// A row of a layer becomes the longest runs of connected samples that lie within a tolerance of one
// line (a cone from the first sample). In a view a run is a line too: it is drawn into a row of
// depths, and whoever is left there says which sample the column shows.
class PlanarRuns : public RowContestant {
 public:
  PlanarRuns();
  ~PlanarRuns() override;

  std::string_view name() const override { return "runs"; }
  void prepare(const BenchLoad& load) override;
  void build() override;

 protected:
  void enterRow(uint32_t thread, uint32_t source_row) override;
  void drawRow(uint32_t thread, const RowView& view, const RowOutput& output) override;

 private:
  struct Runs;
  struct Scratch;

  void addRuns(uint32_t layer, uint32_t source_row, Runs& runs) const;

  float tolerance_ = 0;                            // 1/m
  std::vector<float> inverse_;                     // [n]: 1 / n
  std::vector<Runs> runs_;                         // [row]; of used rows
  std::vector<std::unique_ptr<Scratch>> scratch_;  // [thread]
};

}  // namespace viewloom::bench
