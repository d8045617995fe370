// SPDX-License-Identifier: Apache-2.0
// Finds channels in the parts and views of an OpenEXR file, and reads them into a plane.
#pragma once

#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPixelType.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "files/exr_header.h"

namespace viewloom::files {

struct ExrChannel {
  int part = 0;
  std::string name;  // in that part
  Imf::PixelType type = Imf::HALF;
  int x_sampling = 1;
  int y_sampling = 1;

  bool isSubsampled() const { return x_sampling != 1 || y_sampling != 1; }
};

// The channel a name stands for, see exr_image.h.
std::optional<ExrChannel> findExrChannel(const Imf::MultiPartInputFile& file,
                                         const std::string& name);

// Samples of a plane lie pixel by pixel and have one type. May throw what OpenEXR throws.
class ExrPlaneReader {
 public:
  // `window`: what the plane covers, in the file's px.
  ExrPlaneReader(Imf::MultiPartInputFile& file, int part, const ExrWindow& window,
                 Imf::PixelType type, size_t plane_channels);

  // names[i] goes to the i-th sample of each pixel, unless it is empty. What the file has no
  // samples for stays as it is.
  void readInto(std::vector<uint8_t>& plane, std::span<const std::string> names);

 private:
  void readRows(int begin_y, int end_y, std::vector<uint8_t>& rows,
                std::span<const std::string> names);
  void copyRow(int y, const uint8_t* row, std::vector<uint8_t>& plane) const;

  Imf::InputPart part_;
  Imf::PixelType type_;
  size_t sample_bytes_;
  size_t pixel_bytes_;
  ExrWindow window_;
  ExrWindow visible_;  // of the window, what the file has
  int data_begin_x_ = 0;
  int data_width_px_ = 0;
};

// Float samples of one channel, subsampled or not, over the part's data window.
class ExrSubsampledChannel {
 public:
  ExrSubsampledChannel(Imf::MultiPartInputFile& file, const ExrChannel& channel);

  // Linear between the samples, at a pixel of the file. Beyond the edge ones, those.
  float at(int x, int y) const;

 private:
  float sample(int column, int row) const;

  int first_column_ = 0, first_row_ = 0;  // x / x_sampling of the first sample
  int columns_ = 0, rows_ = 0;
  int x_sampling_ = 1, y_sampling_ = 1;
  std::vector<float> samples_;
};

}  // namespace viewloom::files
