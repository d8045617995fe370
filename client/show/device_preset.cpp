// SPDX-License-Identifier: Apache-2.0
#include "show/device_preset.h"

namespace viewloom::show {
namespace {

struct Device {
  std::string_view serial_prefix;
  SizePx screen_px;
  std::string_view preset;
};

// Looking Glass Factory's device templates. Panels of one size: the older device first.
constexpr Device kDevices[] = {
    {"LKG-2K", {2560, 1600}, "8_9_gen1"}, {"LKG-4K", {3840, 2160}, "15_6_gen1"},
    {"LKG-A", {3840, 2160}, "16_gen2"},   {"LKG-8K", {7680, 4320}, "8k_gen1"},
    {"LKG-B", {7680, 4320}, "32_gen2"},   {"LKG-P", {1536, 2048}, "portrait"},
    {"LKG-E", {1440, 2560}, "go_p"},      {"LKG-F", {1536, 2048}, "kiosk"},
    {"LKG-J", {3840, 2160}, "16_gen3_l"}, {"LKG-H", {2160, 3840}, "16_gen3_p"},
    {"LKG-L", {7680, 4320}, "32_gen3_l"}, {"LKG-K", {4320, 7680}, "32_gen3_p"},
    {"LKG-D", {7680, 4320}, "65"},
};

}  // namespace

std::string_view presetOf(const Calibration& calibration) {
  for (const Device& device : kDevices) {
    if (calibration.serial.starts_with(device.serial_prefix)) return device.preset;
  }
  for (const Device& device : kDevices) {
    if (calibration.screen_px == device.screen_px) return device.preset;
  }
  return "portrait";
}

}  // namespace viewloom::show
