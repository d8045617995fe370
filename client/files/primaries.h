// SPDX-License-Identifier: Apache-2.0
// Which primaries stated chromaticities are, and colour of any others.
#pragma once

#include <OpenEXR/ImfChromaticities.h>

#include <optional>
#include <string>

#include "files/plane_image.h"

namespace viewloom::files {

// Of those that the wire knows, all with white D65; nothing for others, as ACEScg.
std::optional<v1::ColorPrimaries> knownPrimaries(const Imf::Chromaticities& chromaticities);

// The primaries of a RGBA16F image: those that its file states, BT709 without. The colour of
// unknown ones is converted to BT2020, its white adapted to D65 (Bradford). Chromaticities that
// span no colours are refused.
absl::StatusOr<v1::ColorPrimaries> settlePrimaries(const std::string& file, PlaneImage& image);
// The same for RGBA16F px alone.
absl::StatusOr<v1::ColorPrimaries> settlePrimaries(const std::string& file,
                                                   const Imf::Chromaticities& stated,
                                                   std::vector<uint8_t>& rgba16f);

}  // namespace viewloom::files
