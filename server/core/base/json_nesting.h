// SPDX-License-Identifier: Apache-2.0
// How deep a JSON text nests, before it is read: code that walks a value in depth, such as a copy
// or a dump, would overflow its stack.
#pragma once

#include <cstddef>
#include <string_view>

namespace viewloom {

// Far deeper than any text that means something here.
inline constexpr size_t kJsonDepthMax = 64;

// Whether lists and objects nest deeper than so many levels, in time linear in the length: a
// callback of the parser would take quadratic time. The text need not be JSON.
bool isNestedDeeply(std::string_view json, size_t depth_max = kJsonDepthMax);

}  // namespace viewloom
