// SPDX-License-Identifier: Apache-2.0
// Streams, displays, presets and layouts as JSON. Names and units are those of the protos; a 64-bit
// number that may pass 2^53 is a string, as in proto's own JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "access/caller.h"
#include "display/atlas_layout.h"
#include "publish/broadcaster.h"
#include "publish/stream_directory.h"

namespace viewloom {

// With the cameras of the views, where there are one or two.
nlohmann::json layoutJson(const AtlasLayout& layout);
nlohmann::json encodingJson(const EncodingSpec& encoding);
// Lists hold the streams that the caller sees.
nlohmann::json streamsJson(const StreamDirectory& streams, const Broadcaster& broadcaster,
                           const Caller& caller);
nlohmann::json displaysJson(const Broadcaster& broadcaster, const Caller& caller);
nlohmann::json presetsJson();
// Ranges of the numbers of a display, by their path in proto Display.
nlohmann::json fieldsJson();

}  // namespace viewloom
