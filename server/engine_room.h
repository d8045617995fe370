// SPDX-License-Identifier: Apache-2.0
// The part of a service that makes atlases. A server that only hands out atlases that it is given
// is linked with an empty one: then neither Vulkan nor any engine is in it.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "admission/memory_budget.h"
#include "base/clock.h"
#include "config/config.h"
#include "display/atlas_layout.h"
#include "metrics/metrics.h"
#include "publish/atlas_maker.h"
#include "publish/broadcaster.h"
#include "publish/stream_directory.h"
#include "schedule/fair_shares.h"
#include "video/encoder_choice.h"

namespace viewloom {

// On what atlases are made, for users.
struct EngineRoomDescription {
  std::string device;  // empty: no atlases are made here
  std::string driver;
  bool is_software = false;  // the device is the CPU
};

class EngineRoom : public AtlasMaker {
 public:
  virtual EngineRoomDescription description() const = 0;
  // Memory of this machine that a frame of this format takes once it is prepared, beside its
  // planes, bytes.
  virtual uint64_t preparedBytes(const FrameFormat& format) const = 0;
  // Warnings and errors of the device's validation, so far.
  virtual uint64_t deviceMessageCount() const = 0;
  // Shares of the engines' time. Work for clients beside the engines is paid there, too.
  virtual FairShares& shares() = 0;
};

// Neighbours of the room. All of them outlive it.
struct EngineRoomLinks {
  const Clock& clock;
  const Metrics& metrics;
  Broadcaster& broadcaster;
  StreamDirectory& directory;
  MemoryBudget& memory;
  VideoEncoderChoicePtr video_encoders;
  std::function<void(const std::exception& error)> on_failure;  // see Service
};

// The device fails at the start, and may do better when the server is started again.
struct DeviceFailure : std::runtime_error {
  using runtime_error::runtime_error;
};

// Throws std::runtime_error, in words for users and with the remedy, when there is no device to
// make atlases on; DeviceFailure when there is one and it fails. `encode_thread_count` >= 1.
std::unique_ptr<EngineRoom> openEngineRoom(const Config& config, const AtlasLimits& limits,
                                           uint32_t encode_thread_count, EngineRoomLinks links);

}  // namespace viewloom
