// SPDX-License-Identifier: Apache-2.0
// A frame as the messages of PublishFrames: its header, then its planes in chunks.
#pragma once

#include <functional>

#include "lib/chunk_size.h"
#include "lib/wire_frame.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {

// False = no further message is wanted.
using TakeFrameMessage = std::function<bool(const v1::PublishFramesRequest&)>;

// In the order of the wire, chunks as large as `chunk_bytes` says before each of them. True when
// `take` took all.
bool takeFrameMessages(
    const WireFrame& frame, const TakeFrameMessage& take,
    const std::function<size_t()>& chunk_bytes = [] { return ChunkSize::kMax_bytes; });

}  // namespace viewloom
