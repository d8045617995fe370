// SPDX-License-Identifier: Apache-2.0
// The part of viewloom's build that any walk of depth samples needs: from planes as they came to
// sorted columns of inv_z.
#pragma once

#include "bench/bench_load.h"
#include "gpu/commands.h"
#include "gpu/compute_pass.h"
#include "structure/structure_slot.h"

namespace viewloom::bench {

// The device must outlive it. Thread-safety: none.
class InvZBuild {
 public:
  // Uploads the load's frame.
  InvZBuild(const Device& device, const BenchLoad& load);

  // Those recorded afterwards in the same submission see it.
  void record(Commands commands) const;

  const StructureSlot& slot() const { return slot_; }
  std::vector<Descriptor> colorAndInvZ() const {
    return {slot_.color().asTexels(abi::kBindingColor), slot_.invZ().asTexels(abi::kBindingInvZ)};
  }

 private:
  StructureSlot slot_;
  ComputePass prepare_columns_;
};

}  // namespace viewloom::bench
