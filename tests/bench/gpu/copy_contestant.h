// SPDX-License-Identifier: Apache-2.0
// Moves what viewloom's build must read and write, and nothing else: the floor below any build of
// its structure. It makes no picture.
#pragma once

#include "bench/contestant.h"
#include "bench/gpu/shaders/rival_abi.h"
#include "gpu/compute_pass.h"
#include "gpu/submission.h"

namespace viewloom::bench {

// Ranges that are read and written, in units of 16 bytes and in parts that fit the device's
// bindings: part p of the output is part p of the input over and over again.
struct CopyShape {
  uint32_t read_count = 0;  // in all
  uint32_t part_count = 1;
  uint32_t part_read_count = 0;  // of all parts but the last, which may have fewer
  uint32_t part_written_count = 0;
};

class CopyContestant final : public Contestant {
 public:
  explicit CopyContestant(const Device& device);

  std::string_view name() const override { return "copy"; }
  bool takes(const BenchLoad&) const override { return true; }
  void prepare(const BenchLoad& load) override;
  void build() override;
  void trace() override {}
  Picture picture() override { return {}; }

  const CopyShape& shape() const { return shape_; }
  const Buffer& from() const { return from_; }
  const Buffer& to() const { return to_; }

 private:
  const Device& device_;
  Timeline timeline_;
  CommandRecorder recorder_;
  ComputePass copy_;
  CopyShape shape_;
  Buffer from_;
  TexelView from_texels_;
  Buffer to_;
};

}  // namespace viewloom::bench
