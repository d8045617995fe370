// SPDX-License-Identifier: Apache-2.0
// Output rates and what goes with them that cannot be, each with the field it is refused with.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "e2e/bad_display.h"

namespace viewloom::rpc_bad_times_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr auto kInvalid = grpc::StatusCode::INVALID_ARGUMENT;

v1::TemporalEffect& temporal(v1::OpenDisplay& open) {
  v1::TemporalEffect& effect = *open.mutable_display()->mutable_effects()->mutable_temporal();
  effect.set_output_rate_hz(60);
  return effect;
}

const std::string kTemporal = "open.display.effects.temporal.";

const std::vector<BadDisplay> kTimes = {
    {"rate 0",
     [](auto& o) { temporal(o).set_output_rate_hz(0); },
     {kInvalid, kTemporal + "output_rate_hz"}},
    {"rate NaN",
     [](auto& o) { temporal(o).set_output_rate_hz(kNan); },
     {kInvalid, kTemporal + "output_rate_hz"}},
    {"rate 241",
     [](auto& o) { temporal(o).set_output_rate_hz(241); },
     {kInvalid, kTemporal + "output_rate_hz"}},
    {"mode 99",
     [](auto& o) { temporal(o).set_mode(static_cast<v1::TemporalMode>(99)); },
     {kInvalid, kTemporal + "mode"}},
    {"a bridge back",
     [](auto& o) { temporal(o).set_bridge_s(-0.1); },
     {kInvalid, kTemporal + "bridge_s"}},
    {"a bridge NaN long",
     [](auto& o) { temporal(o).set_bridge_s(kNan); },
     {kInvalid, kTemporal + "bridge_s"}},
    {"a bridge of 11 s",
     [](auto& o) { temporal(o).set_bridge_s(11); },
     {kInvalid, kTemporal + "bridge_s"}},
};

TEST(StreamAtlases, refusesTimesThatCannotBe) {
  expectRefused(kTimes);
}

}  // namespace
}  // namespace viewloom::rpc_bad_times_test
