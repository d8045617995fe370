// SPDX-License-Identifier: Apache-2.0
// Times of day as people and files write them: "2027-01-31T12:00:00Z".
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace viewloom {

// Seconds since 1970, UTC. Tests hand in a function of their own.
using WallClock = std::function<int64_t()>;
int64_t systemSeconds();

std::string utcText(int64_t seconds);
// Takes that form, and "2027-01-31", which is the beginning of that day.
std::optional<int64_t> secondsFromUtc(std::string_view text);

}  // namespace viewloom
