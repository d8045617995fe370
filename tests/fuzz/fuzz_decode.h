// SPDX-License-Identifier: Apache-2.0
// All decoders of foreign bytes, as functions of any bytes. Each returns true if the bytes were
// accepted, and aborts when a promise is broken.
#pragma once

#include <cstdint>
#include <span>

namespace viewloom {

// The first two bytes are the expected width and height, the rest is a JPEG.
bool fuzzJpeg(std::span<const uint8_t> bytes);

// The first two bytes are the expected size less one, the rest is a zstd frame.
bool fuzzZstd(std::span<const uint8_t> bytes);

// The first two bytes are width and height, each less one. The rest is a predicted depth plane.
bool fuzzPredicted(std::span<const uint8_t> bytes);

// The bytes are a script: a header, then chunks. Accepted frames are decoded.
bool fuzzFrame(std::span<const uint8_t> bytes);

// The bytes are a picture file in a container with a parser of our own, or a JPEG's segments.
bool fuzzPicture(std::span<const uint8_t> bytes);

}  // namespace viewloom
