// SPDX-License-Identifier: Apache-2.0
// Pictures of any container but OpenEXR, HEIC and raw video, and decoders of the formats that are
// read in no other way.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "files/container.h"
#include "files/picture.h"

namespace viewloom::files {

// Upright, rows from the top. INVALID_ARGUMENT in the user's words for what is no such picture.
absl::StatusOr<Picture> readPicture(const std::filesystem::path& path, PictureUse use);

// Files in memory; `name` is for messages.

// BMP: uncompressed Windows bitmaps. 8 bits with a palette, 24 and 32 bits, and 16 and 32 bits of
// masks; either order of rows. Palettes of grey give one channel. Run-length coding and fewer bits
// are refused.
absl::StatusOr<Picture> decodeBmp(const std::string& name, std::span<const uint8_t> bytes);

// DPT: depth of the MPI Sintel data set, binary32. Grey of floats, top row first. Optical flow
// (.flo), which begins with the same tag, is refused by its length.
absl::StatusOr<Picture> decodeDpt(const std::string& name, std::span<const uint8_t> bytes);

// NPY: arrays of numpy as pictures. Versions 1 to 3, C or Fortran order, either byte order; floats
// of 16, 32 and 64 bits, whole numbers of 8 to 64. Shapes: (height, width), with 1 to 4 channels
// behind it or before it, and any ones in front.
absl::StatusOr<Picture> decodeNpy(const std::string& name, std::span<const uint8_t> bytes);

// TIFF, read by libtiff. The first picture of the file, turned by its Orientation tag: grey and RGB
// of 8 and 16 bits as stored (white-is-zero turned round), other whole numbers and floats as
// binary32, in strips or tiles, of any compression that libtiff knows. Palettes, YCbCr and grey of
// fewer bits are read as colour alone.
absl::StatusOr<Picture> decodeTiff(const std::string& name, std::span<const uint8_t> bytes,
                                   PictureUse use);

// WebP, read by libwebp. Lossy and lossless: three channels, or four with alpha, of 8 bits; turned
// by the EXIF chunk. Animations are refused.
absl::StatusOr<Picture> decodeWebp(const std::string& name, std::span<const uint8_t> bytes);

}  // namespace viewloom::files
