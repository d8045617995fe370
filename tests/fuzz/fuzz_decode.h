// SPDX-License-Identifier: Apache-2.0
// What foreign bytes go through, as functions of any bytes. Each returns whether they
// were accepted, and aborts when a promise is broken.
#pragma once

#include <cstdint>
#include <span>

namespace viewloom {

// The bytes are a JPEG; its size is taken from the first two.
bool fuzzJpeg(std::span<const uint8_t> bytes);

// The bytes are a zstd frame; the size it should have is taken from the first two.
bool fuzzZstd(std::span<const uint8_t> bytes);

// The bytes are a predicted plane of depth; its sides, less one, are taken from the first two.
bool fuzzPredicted(std::span<const uint8_t> bytes);

// The bytes are a script: a header, then chunks. What is accepted is decoded.
bool fuzzFrame(std::span<const uint8_t> bytes);

// The bytes are a picture file of a container that is read by hand, or a JPEG's segments.
bool fuzzPicture(std::span<const uint8_t> bytes);

}  // namespace viewloom
