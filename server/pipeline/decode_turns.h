// SPDX-License-Identifier: Apache-2.0
// Decoding of frames in fair shares, paid by their publishers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "frame/frame_sink.h"
#include "schedule/fair_shares.h"

namespace viewloom {

// Place of the frame whose publisher, or stream, has the smallest share so far; the oldest of
// equals. Expects at least one.
size_t turnToDecode(const FairShares& shares, const std::vector<FrameOrigin>& waiting);
// Never throws: without memory for the account, the time is nobody's.
void payForDecoding(FairShares& shares, const FrameOrigin& origin, int64_t cpu_ns);

}  // namespace viewloom
