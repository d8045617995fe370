// SPDX-License-Identifier: Apache-2.0
// A quilt by its address, with what a player has to know of it.
#pragma once

#include <cstdint>
#include <string>

namespace viewloom::bridge {

struct QuiltShape {
  uint32_t columns = 0;
  uint32_t rows = 0;
  uint32_t width_px = 0;  // of the whole
  uint32_t height_px = 0;
  double aspect = 0;  // of a view
};

struct AddressedQuilt {
  std::string uri;
  uint32_t columns = 0;
  uint32_t rows = 0;
  uint32_t view_count = 0;
  double aspect = 0;
};

}  // namespace viewloom::bridge
