// SPDX-License-Identifier: Apache-2.0
// Depths that stay while what is measured of a moving scene merely trembles.
#pragma once

#include "display/source_demand.h"

namespace viewloom {

// Thread-safety: none; one owner.
class SettledRange {
 public:
  // How much wider than what is measured it is when it is settled anew, at either end, as a share
  // of the nearest 1/Z; it stays while it holds what is measured and is up to twice that wider.
  // A scene that moves by less than 6 % of its distance moves nothing.
  static constexpr double kMargin = 1.0 / 16;

  const InvZRange& settle(const InvZRange& measured);

 private:
  InvZRange settled_;
};

}  // namespace viewloom
