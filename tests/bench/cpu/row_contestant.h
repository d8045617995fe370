// SPDX-License-Identifier: Apache-2.0
// Base of contestants that make views row by row: no ray of theirs leaves its row of the source.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bench/contestant.h"

namespace viewloom::bench {

// Column p of a tile sees, at inv_z, the source at x = start_px + step_px * p + eye_px_m * inv_z.
struct RowView {
  float start_px = 0;
  float step_px = 1;
  float eye_px_m = 0;
};

// One row of the atlas, of one view; inv_z is null where colour alone is wanted.
struct RowOutput {
  uint32_t* rgba = nullptr;
  float* inv_z = nullptr;
  uint32_t width_px = 0;
};

// A row of a view is made from the row of the source that is nearest. Where no surface is met, the
// background stays.
class RowContestant : public Contestant {
 public:
  bool takes(const BenchLoad& load) const override;
  void prepare(const BenchLoad& load) override;
  void trace() override { traceRows(nullptr); }
  Picture picture() override;

 protected:
  // Threads are numbered from 0; each is in one row of the source at a time.
  virtual void enterRow(uint32_t thread, uint32_t source_row) = 0;
  virtual void drawRow(uint32_t thread, const RowView& view, const RowOutput& output) = 0;

  const LoadSource& source() const { return load_->source; }
  const BenchLoad& load() const { return *load_; }
  uint32_t background() const { return background_; }
  size_t usedRowCount() const { return rows_.size(); }
  uint32_t usedRow(size_t index) const { return rows_[index].source_row; }

 private:
  struct Target {
    uint32_t view = 0;
    size_t offset_px = 0;      // in the atlas
    bool is_repeated = false;  // the target before it is the same row of the same view
  };
  struct UsedRow {
    uint32_t source_row = 0;
    std::vector<Target> targets;
  };

  void traceRows(float* inv_z);

  const BenchLoad* load_ = nullptr;
  uint32_t background_ = 0;
  std::vector<RowView> views_;
  std::vector<UsedRow> rows_;
  std::vector<uint32_t> rgba_;  // [row][column] of the atlas
};

}  // namespace viewloom::bench
