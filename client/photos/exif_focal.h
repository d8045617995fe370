// SPDX-License-Identifier: Apache-2.0
// The focal length that Exif states for a camera whose film is 35 mm wide.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace viewloom::photos {

// FocalLengthIn35mmFilm (tag 0xA405), mm. `tiff` begins with the byte order, as "MM\0*". Nothing
// where it is absent, 0 (unknown) or out of reach.
std::optional<double> focal35mm(std::span<const uint8_t> tiff);

// The TIFF bytes of an Exif item of HEIF: behind its four bytes that say how far ahead they are.
std::span<const uint8_t> tiffOfItem(std::span<const uint8_t> item);

}  // namespace viewloom::photos
