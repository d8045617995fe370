// SPDX-License-Identifier: Apache-2.0
// What the displays of a stream see, seen from its source → proto Wanted.
#pragma once

#include <span>

#include "encode/encoded_band.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {

// From the newest atlas of each display; a display without one adds nothing but its count.
v1::Wanted wantedToProto(std::span<const AtlasPtr> atlases, uint32_t display_count);

}  // namespace viewloom
