// SPDX-License-Identifier: Apache-2.0
#include "commands/doctor_checks.h"
#include "engine_room.h"

namespace viewloom {
namespace {

class EmptyRoom final : public EngineRoom {
 public:
  void offerFrame(const FrameOrigin&, FramePtr frame, ReportFrame report) override {
    report({.number = frame->format.number,
            .outcome = FrameOutcome::kRefused,
            .reason = "this server was built without engines and makes no pictures; publish to one "
                      "that has them"});
  }
  void forgetStream(const std::string&) override {}
  void serveDisplays(const std::string&) override {}
  void serveEyes(uint64_t) override {}
  void drain() override {}
  EngineRoomDescription description() const override { return {}; }
  uint64_t preparedBytes(const FrameFormat&) const override { return 0; }
  uint64_t deviceMessageCount() const override { return 0; }
  FairShares& shares() override { return shares_; }

 private:
  FairShares shares_;
};

}  // namespace

std::unique_ptr<EngineRoom> openEngineRoom(const Config&, const AtlasLimits&, uint32_t,
                                           EngineRoomLinks) {
  return std::make_unique<EmptyRoom>();
}

std::vector<Finding> checkEngines(const Config&) {
  return {{Verdict::kAdvice, "engines",
           "none are built in: this server hands out atlases and makes none",
           "to make atlases, build with VIEWLOOM_ENGINES=ON"}};
}

}  // namespace viewloom
