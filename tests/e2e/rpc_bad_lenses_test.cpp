// SPDX-License-Identifier: Apache-2.0
// Lenses that cannot be: each with the field it is refused with.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "e2e/bad_display.h"

namespace viewloom::rpc_bad_lenses_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr auto kInvalid = grpc::StatusCode::INVALID_ARGUMENT;
const std::string kLens = "open.display.effects.lens.";

v1::LensEffect& lens(v1::OpenDisplay& open) {
  v1::LensEffect& effect = *open.mutable_display()->mutable_effects()->mutable_lens();
  effect.set_aperture_radius_m(0.01);
  return effect;
}

const std::vector<BadDisplay> kLenses = {
    {"no aperture",
     [](auto& o) { lens(o).clear_aperture_radius_m(); },
     {kInvalid, kLens + "aperture_radius_m"}},
    {"a negative aperture",
     [](auto& o) { lens(o).set_aperture_radius_m(-0.01); },
     {kInvalid, kLens + "aperture_radius_m"}},
    {"an infinite aperture",
     [](auto& o) { lens(o).set_aperture_radius_m(kInfinity); },
     {kInvalid, kLens + "aperture_radius_m"}},
    {"aperture NaN",
     [](auto& o) { lens(o).set_aperture_radius_m(kNan); },
     {kInvalid, kLens + "aperture_radius_m"}},
    {"two apertures",
     [](auto& o) { lens(o).set_automatic_aperture(true); },
     {kInvalid, kLens + "aperture_radius_m"}},
    {"focus at the eye",
     [](auto& o) { lens(o).set_focus_distance_m(0); },
     {kInvalid, kLens + "focus_distance_m"}},
    {"focus behind",
     [](auto& o) { lens(o).set_focus_distance_m(-1); },
     {kInvalid, kLens + "focus_distance_m"}},
    {"focus at infinity",
     [](auto& o) { lens(o).set_focus_distance_m(kInfinity); },
     {kInvalid, kLens + "focus_distance_m"}},
    {"two blades", [](auto& o) { lens(o).set_blades(2); }, {kInvalid, kLens + "blades"}},
    {"17 blades", [](auto& o) { lens(o).set_blades(17); }, {kInvalid, kLens + "blades"}},
    {"turned by NaN",
     [](auto& o) { lens(o).set_rotation_rad(kNan); },
     {kInvalid, kLens + "rotation_rad"}},
    {"65 samples", [](auto& o) { lens(o).set_samples(65); }, {kInvalid, kLens + "samples"}},
    {"257 gathered samples",
     [](auto& o) { lens(o).set_gathered_samples(257); },
     {kInvalid, kLens + "gathered_samples"}},
    {"mode 99",
     [](auto& o) { lens(o).set_mode(static_cast<v1::GatherMode>(99)); },
     {kInvalid, kLens + "mode"}},
    {"quality 99",
     [](auto& o) { o.mutable_display()->set_quality(static_cast<v1::Quality>(99)); },
     {kInvalid, "open.display.quality"}},
};

TEST(StreamAtlases, refusesLensesThatCannotBe) {
  expectRefused(kLenses);
}

}  // namespace
}  // namespace viewloom::rpc_bad_lenses_test
