// SPDX-License-Identifier: Apache-2.0
// A frame as the walk takes it in: its structures on the device.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "admission/memory_budget.h"
#include "engine/engine.h"
#include "gpu/submission.h"
#include "structure/build_costs.h"
#include "structure/frame_structure.h"
#include "structure/structure_builder.h"
#include "walk/device_use.h"
#include "walk/submission_clock.h"

namespace viewloom {

// Builds structures on a device. Thread-safety: as Timeline and StructureBuilder.
struct StructureWorks {
  explicit StructureWorks(const Device& used_device, MemoryBudget& budget = unboundedMemory())
      : device(used_device), memory(budget), timeline(used_device), builder(used_device) {}

  const Device& device;
  MemoryBudget& memory;
  Timeline timeline;
  const StructureBuilder builder;
  SubmissionClock clock;
  mutable DeviceUse use;  // by anybody but the warm-up; plans note it, too
  BuildCosts build_costs{kBuiltPxStart_ns};

 private:
  // Until something was measured, as slow as a software device with one core.
  static constexpr double kBuiltPxStart_ns = 30;
};

// Memory that all builds of a stream share, one after the other.
struct StreamBuilds {
  std::mutex mutex;  // guards the memory, from the upload until the device is done
  FrameBuildMemory memory;
  std::shared_ptr<const Reservation> reserved;  // held by the forms that hold the memory, too
};

class WalkedFrame final : public PreparedFrame {
 public:
  // `works` outlives it.
  WalkedFrame(StructureWorks& works, std::shared_ptr<StreamBuilds> builds)
      : works_(works), builds_(std::move(builds)) {}

  void take(FramePtr frame) override;
  void reserve() override;
  int64_t prepare(const Clock& clock, const PreparationEvents& events) override;
  FrameMeasures measures() const override;

  // Memory of this machine that such a frame takes, with what builds take beside it.
  static uint64_t bytesFor(const Device& device, const FrameFormat& format);

  const std::vector<FrameShape>& shapes() const { return shapes_; }
  // Once it is prepared.
  const FrameStructure& structure() const { return form_->structure; }

 private:
  // On the device, with the commands that build it.
  struct Form {
    Form(const Device& device, const FrameBuildMemory& build_memory,
         std::vector<FrameShape> part_shapes, Reservation form_memory)
        : reserved(std::move(form_memory)),
          structure(device, build_memory),
          recorder(device),
          shapes(std::move(part_shapes)) {}

    const Reservation reserved;
    std::shared_ptr<const Reservation> build_reserved;
    FrameStructure structure;
    CommandRecorder recorder;
    const std::vector<FrameShape> shapes;
  };

  void makeRoom();
  Reservation reserveBytes(uint64_t bytes) const;
  int64_t build(const Clock& clock, const PreparationEvents& events);
  void buildInPieces(const PreparationEvents& events);

  StructureWorks& works_;
  const std::shared_ptr<StreamBuilds> builds_;
  FramePtr frame_;                  // that is not prepared yet
  std::vector<FrameShape> shapes_;  // of its parts
  std::optional<Form> form_;        // made when it is first needed
};

}  // namespace viewloom
