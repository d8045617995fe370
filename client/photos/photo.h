// SPDX-License-Identifier: Apache-2.0
// Photos with depth as phones write them: HEIC, whose second, auxiliary image is the depth, and
// JPEG with a depth map in XMP or as an auxiliary picture.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/status.h"
#include "files/picture.h"
#include "files/plane_image.h"
#include "photos/heif_image.h"
#include "photos/photo_depth.h"

namespace viewloom::photos {

// A HEIC file, told as files::containerOf tells it, or a JPEG with depth inside.
bool isPhoto(const std::string& file);

struct PhotoDescription {
  uint32_t width_px = 0;  // as shown, once the file's turns and mirrors are applied
  uint32_t height_px = 0;
  ColorProfile profile;
  std::optional<double> focal_35mm;  // FocalLengthIn35mmFilm of Exif, mm
  std::optional<PhotoDepth> depth;
  std::vector<std::string> other_types;  // of auxiliary images that are no depth
};

// A file whose boxes are read; its pixels are decoded when they are asked for. Thread-safety: none;
// one owner.
class Photo {
 public:
  // INVALID_ARGUMENT for what is neither, is cut short, or is larger than planes may be.
  static absl::StatusOr<Photo> open(const std::filesystem::path& path);

  const PhotoDescription& description() const { return description_; }

  // RGB8. Alpha is left out.
  absl::StatusOr<files::PlaneImage> readColor() const;

  // DEPTH_U16 of the codes as stored. INVALID_ARGUMENT without depth, with what to do.
  absl::StatusOr<files::PlaneImage> readDepth() const;

  // The error with which readDepth refuses a photo, before anything is decoded.
  absl::Status requireDepth() const;

 private:
  Photo(std::string name, std::vector<uint8_t> bytes)
      : name_(std::move(name)), bytes_(std::move(bytes)) {}

  absl::Status readBoxes();
  absl::Status readJpeg();
  void describe();

  std::string name_;
  std::vector<uint8_t> bytes_;  // libheif reads in them for as long as it lives
  HeifOwned<heif_context> context_;
  HeifOwned<heif_image_handle> color_;
  HeifOwned<heif_image_handle> depth_;        // null without one
  std::optional<files::Picture> jpeg_depth_;  // of JPEG
  bool is_jpeg_ = false;
  PhotoDescription description_;
};

}  // namespace viewloom::photos
