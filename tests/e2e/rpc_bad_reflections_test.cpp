// SPDX-License-Identifier: Apache-2.0
// Reflections that cannot be served: each with the field it is refused with.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "e2e/bad_display.h"

namespace viewloom::rpc_bad_reflections_test {
namespace {

constexpr auto kInvalid = grpc::StatusCode::INVALID_ARGUMENT;
const std::string kReflection = "open.display.effects.reflection.";

v1::ReflectionEffect& reflection(v1::OpenDisplay& open) {
  v1::ReflectionEffect& effect = *open.mutable_display()->mutable_effects()->mutable_reflection();
  effect.set_bounces(1);
  return effect;
}

const std::vector<BadDisplay> kReflections = {
    {"five bounces",
     [](auto& o) { reflection(o).set_bounces(5); },
     {kInvalid, kReflection + "bounces"}},
    {"65 samples",
     [](auto& o) { reflection(o).set_samples(65); },
     {kInvalid, kReflection + "samples"}},
    {"environment of more than 24 bits",
     [](auto& o) { reflection(o).set_environment_rgb(0x1000000); },
     {kInvalid, kReflection + "environment_rgb"}},
};

TEST(StreamAtlases, refusesReflectionsThatCannotBe) {
  expectRefused(kReflections);
}

}  // namespace
}  // namespace viewloom::rpc_bad_reflections_test
