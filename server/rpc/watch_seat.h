// SPDX-License-Identifier: Apache-2.0
// Place of a call in the broadcaster.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "publish/subscriber.h"
#include "rpc/watch_call.h"

namespace viewloom {

// Passes on to the call what the broadcaster offers. Thread-safety: as Subscriber.
class WatchCall::Seat final : public Subscriber {
 public:
  Seat(const std::shared_ptr<WatchCall>& call, uint64_t number, std::string field)
      : call_(call), identity_(call->identity_), number_(number), field_(std::move(field)) {}

  std::string identity() const override { return identity_; }
  void begin(GrowingAtlasPtr atlas) override {
    if (const auto call = call_.lock()) call->begin(number_, std::move(atlas));
  }
  void noteGrowth() override {
    if (const auto call = call_.lock()) call->noteGrowth(number_);
  }
  void offer(AtlasPtr atlas) override {
    if (const auto call = call_.lock()) call->offer(number_, std::move(atlas));
  }
  void end(const absl::Status& status) override {
    if (const auto call = call_.lock()) call->endSeat(number_, inField(status));
  }
  // Errors of the display name the field that asked for it.
  absl::Status inField(const absl::Status& status) const {
    const std::string of = fieldOf(status);
    return of.empty() || of.starts_with("eye_poses") ? status : withFieldPrefix(status, field_);
  }

 private:
  const std::weak_ptr<WatchCall> call_;
  const std::string identity_;
  const uint64_t number_;
  const std::string field_;  // that asked for the display
};

}  // namespace viewloom
