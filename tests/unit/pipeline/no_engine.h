// SPDX-License-Identifier: Apache-2.0
// An engine for tests that make no pictures.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "engine/engines.h"

namespace viewloom::test {

// Takes all frames, and is never asked for more.
class NoEngine : public Engine {
 public:
  TraceMethod method() const override { return TraceMethod::kSweep; }
  void connect(EngineEvents) override {}
  bool takes(const Frame&) const override { return true; }
  uint64_t preparedBytes(const FrameFormat&) const override { return 0; }
  std::unique_ptr<FramePreparer> preparer() override { return nullptr; }
  PlanPtr plan(const PicturePtr&, const PreparedFrame&) const override { return nullptr; }
  bool isReady(const AtlasOrder&, std::function<void()>) override { return true; }
  bool hasRoomForEyes(const std::string&) override { return true; }
  std::unique_ptr<Making> begin(AtlasOrder, HandOn) override { return nullptr; }
  std::optional<std::chrono::nanoseconds> workAhead() override { return std::nullopt; }
  void drain() override {}
};

inline Engines noEngines() {
  Engines engines;
  engines.all.push_back(std::make_unique<NoEngine>());
  return engines;
}

}  // namespace viewloom::test
