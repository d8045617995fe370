// SPDX-License-Identifier: Apache-2.0
// Files as other tools write them: OpenEXR and PNG by their own libraries.
#pragma once

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPixelType.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "inputs/input_reader.h"

namespace viewloom::test {

struct WrittenChannel {
  std::string name;
  Imf::PixelType type;
  std::function<float(int x, int y)> value;
};

// One flat part of scan lines. `edit` may add attributes.
void writeExr(
    const std::filesystem::path& path, int width_px, int height_px,
    const std::vector<WrittenChannel>& channels,
    const std::function<void(Imf::Header&)>& edit = [](Imf::Header&) {});

// channels: 1 or 3; bits: 8 or 16. samples: [height][width][channels].
void writePng(const std::filesystem::path& path, uint32_t width_px, uint32_t height_px,
              uint32_t channels, uint32_t bits, const std::vector<uint16_t>& samples);

// Baseline JPEG of quality 98 without subsampling. rgb: [height][width][3].
void writeJpeg(const std::filesystem::path& path, int width_px, int height_px,
               const std::vector<uint8_t>& rgb);

// Reads one frame with the settings; fails the test when it cannot.
inputs::ReadInput readInput(const inputs::InputSettings& settings, const inputs::InputFiles& files);

// Depth in metres of a frame's first layer; infinity for the sky, NaN without surface.
double depthAt(const inputs::ReadInput& read, uint32_t x, uint32_t y);

// The refusal of files that cannot be read with the settings.
std::string refusalOf(const inputs::InputSettings& settings, const inputs::InputFiles& files);

}  // namespace viewloom::test
