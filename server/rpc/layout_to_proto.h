// SPDX-License-Identifier: Apache-2.0
// How views lie in an atlas and how it is packed → proto AtlasLayout.
#pragma once

#include "display/atlas_layout.h"
#include "display/display_spec.h"
#include "viewloom/v1/atlas.pb.h"

namespace viewloom {

v1::BandEncoding bandEncodingToProto(BandEncoding encoding);
v1::AtlasEncoding encodingToProto(const EncodingSpec& encoding);

// Without views and encoding: what a preset says.
v1::AtlasLayout gridToProto(const AtlasLayout& layout);
// Everything.
v1::AtlasLayout layoutToProto(const AtlasLayout& layout, const EncodingSpec& encoding);

}  // namespace viewloom
