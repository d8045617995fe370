// SPDX-License-Identifier: Apache-2.0
// What the displays of a stream see, seen from its source → proto Wanted.
#pragma once

#include <span>

#include "display/source_demand.h"
#include "encode/encoded_band.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {

// From the newest atlas of each display, and the depths (of as many) between which its views are to
// find something; a display without one adds nothing but its count.
v1::Wanted wantedToProto(std::span<const AtlasPtr> atlases, std::span<const InvZRange> depths,
                         uint32_t display_count);

}  // namespace viewloom
