// SPDX-License-Identifier: Apache-2.0
// Somebody who wants the newest atlas of a display.
#pragma once

#include <string>

#include "base/status.h"
#include "encode/encoded_band.h"
#include "publish/growing_atlas.h"

namespace viewloom {

// Called from any thread, one call at a time per subscriber. No method may block.
class Subscriber : public AtlasReader {
 public:
  // Client in whose share of memory and engine time the display counts: a proven identity or an
  // address; empty = the server itself.
  virtual std::string identity() const { return ""; }
  // An atlas is being made. It is offered once it is whole; until then it may be abandoned.
  virtual void begin(GrowingAtlasPtr /*atlas*/) {}
  void noteGrowth() override {}
  // The newest whole atlas. Keep it or drop it; it stays valid as long as it is held.
  virtual void offer(AtlasPtr atlas) = 0;
  // The display cannot be served (its layout does not fit the stream), or the server drains (OK).
  // Nothing is offered afterwards.
  virtual void end(const absl::Status& status) = 0;
};

}  // namespace viewloom
