// SPDX-License-Identifier: Apache-2.0
// Codes atlases as the pictures of a movie.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/status.h"
#include "video/encoder_choice.h"
#include "video/tiled_picture.h"

namespace viewloom {

struct MovieCoding {
  AtlasTiles atlas;
  VideoTiles video;           // of fitVideoTiles()
  uint32_t qp = 24;           // quantisation, kVideoQpMin..kVideoQpMax
  uint32_t thread_count = 1;  // as in VideoFormat
  VideoEncoderChoicePtr encoders = VideoEncoderChoice::openH264();
};

// Thread-safety: none; one thread at a time.
class MovieCoder {
 public:
  // Errors as VideoEncoderChoice::make.
  static absl::StatusOr<std::unique_ptr<MovieCoder>> make(const MovieCoding& coding);
  // Bytes that one holds.
  static uint64_t memoryBytes(const MovieCoding& coding);

  // Codes an atlas. At least every two seconds comes
  // a picture that refers to no other, so that players can seek. `time_ns`: since the first one.
  // The access unit in Annex B format is valid until the next call. Errors as VideoEncoder::encode.
  absl::StatusOr<std::span<const uint8_t>> code(const AtlasColors& colors, int64_t time_ns);
  // Codes the last atlas once more. Expects one.
  absl::StatusOr<std::span<const uint8_t>> codeAgain(int64_t time_ns);

 private:
  MovieCoder(const MovieCoding& coding, std::unique_ptr<VideoEncoder> encoder);

  TiledPicture picture_;
  const std::unique_ptr<VideoEncoder> encoder_;
  VideoPicture newest_;
  std::vector<uint8_t> access_unit_;
  bool needs_sync_ = true;
  int64_t sync_ns_ = 0;  // time of the last picture without a reference
};

}  // namespace viewloom
