// SPDX-License-Identifier: Apache-2.0
// The rival "rows": a scan converter that maps every sample of a row into every view.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "bench/cpu/row_contestant.h"

namespace viewloom::bench {

// Neighbours of a layer that are connected span a segment, in inv_z and in colour; where a row is
// cut, a sample goes on flat for half a px. Within a layer segments are drawn in the order in which
// later ones hide earlier ones (McMillan), so only layers are compared by inv_z.
class SampleRows : public RowContestant {
 public:
  SampleRows();
  ~SampleRows() override;

  std::string_view name() const override { return "rows"; }
  void prepare(const BenchLoad& load) override;
  // Whatever a row needs is made while the row is in cache.
  void build() override {}

 protected:
  void enterRow(uint32_t thread, uint32_t source_row) override;
  void drawRow(uint32_t thread, const RowView& view, const RowOutput& output) override;

 private:
  struct Scratch;
  std::vector<std::unique_ptr<Scratch>> scratch_;  // [thread]
};

}  // namespace viewloom::bench
