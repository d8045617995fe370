// SPDX-License-Identifier: Apache-2.0
#include "engine_room.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "config/kernel_folder.h"
#include "engine/make_engines.h"
#include "gpu/device.h"
#include "gpu/device_error.h"
#include "pipeline/pipeline.h"

namespace viewloom {
namespace {

using OnFailure = std::function<void(const std::exception& error)>;

OnFailure inWords(OnFailure on_failure) {
  return [on_failure = std::move(on_failure)](const std::exception& error) {
    on_failure(std::runtime_error(deviceErrorText(error)));
  };
}

class DeviceRoom final : public EngineRoom {
 public:
  DeviceRoom(const Config& config, const AtlasLimits& limits, uint32_t encode_thread_count,
             EngineRoomLinks links)
      : device_({.select = config.device,
                 .kernel_folder = kernelFolder(config.kernel_folder),
                 .validation = config.validation}),
        engines_(makeEngines(device_, {.trace_slot_count = config.pipeline.trace_slots,
                                       .warms_up = config.pipeline.warm_up,
                                       .memory = links.memory})),
        pipeline_({.engines = engines_,
                   .clock = links.clock,
                   .metrics = links.metrics,
                   .broadcaster = links.broadcaster,
                   .directory = links.directory,
                   .on_failure = inWords(std::move(links.on_failure)),
                   .memory = links.memory},
                  {.encode_thread_count = encode_thread_count,
                   .video_thread_count = config.pipeline.video_threads,
                   .video_encoders = std::move(links.video_encoders),
                   .structure_slots_per_stream = config.pipeline.structure_slots,
                   .atlas_limits = limits}) {}

  void offerFrame(const FrameOrigin& origin, FramePtr frame, ReportFrame report) override {
    pipeline_.offerFrame(origin, std::move(frame), std::move(report));
  }
  bool wantsFrame(const std::string& stream) override { return pipeline_.wantsFrame(stream); }
  size_t nextToDecode(const std::vector<FrameOrigin>& waiting) override {
    return pipeline_.nextToDecode(waiting);
  }
  void noteDecoded(const FrameOrigin& origin, int64_t cpu_ns) override {
    pipeline_.noteDecoded(origin, cpu_ns);
  }
  void onWanted(std::function<void(const std::string&)> then) override {
    pipeline_.onWanted(std::move(then));
  }
  void noteLost(const std::string& stream) override { pipeline_.noteLost(stream); }
  void forgetStream(const std::string& stream) override { pipeline_.forgetStream(stream); }
  void serveDisplays(const std::string& stream) override { pipeline_.serveDisplays(stream); }
  void serveEyes(uint64_t display_id) override { pipeline_.serveEyes(display_id); }
  void drain() override { pipeline_.drain(); }

  EngineRoomDescription description() const override {
    const DeviceInfo& info = device_.info();
    return {.device = info.name, .driver = info.driver, .is_software = info.is_software};
  }
  uint64_t preparedBytes(const FrameFormat& format) const override {
    return pipeline_.preparedBytes(format);
  }
  uint64_t deviceMessageCount() const override { return device_.validationLog().messageCount(); }
  FairShares& shares() override { return pipeline_.shares(); }

 private:
  const Device device_;
  const Engines engines_;
  Pipeline pipeline_;
};

}  // namespace

std::unique_ptr<EngineRoom> openEngineRoom(const Config& config, const AtlasLimits& limits,
                                           uint32_t encode_thread_count,
                                           EngineRoomLinks links) try {
  return std::make_unique<DeviceRoom>(config, limits, encode_thread_count, std::move(links));
} catch (const std::exception& error) {
  if (mayPass(error)) throw DeviceFailure(deviceErrorText(error));
  throw std::runtime_error(deviceErrorText(error));
}

}  // namespace viewloom
