// SPDX-License-Identifier: Apache-2.0
// Packs bytes with zstd for tests that unpack them.
#pragma once

#include <cstdint>
#include <vector>

namespace viewloom {

enum class ZstdSize : uint8_t { kStated, kOpen };

// One zstd frame; its header says how many bytes it holds, or leaves it open as a pipe does.
std::vector<uint8_t> zstdFrame(const std::vector<uint8_t>& content, ZstdSize size);

}  // namespace viewloom
