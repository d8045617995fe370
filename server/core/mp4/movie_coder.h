// SPDX-License-Identifier: Apache-2.0
// Codes atlases as the pictures of a movie.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
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

// A movie holds one set of parameters. So an encoder that fails is replaced by another of the same
// kind, which begins with a picture that refers to no other. OpenH264 takes its place where it
// fails at the first picture. Thread-safety: none; one thread at a time.
class MovieCoder {
 public:
  // Errors as VideoEncoderChoice::begin.
  static absl::StatusOr<std::unique_ptr<MovieCoder>> make(const MovieCoding& coding);
  // Bytes that one holds.
  static uint64_t memoryBytes(const MovieCoding& coding);

  // Codes an atlas. At least every two seconds comes a picture that refers to no other, so that
  // players can seek. `time_ns`: since the first one. The access unit in Annex B format is valid
  // until the next call. Errors as VideoEncoder::encode, if a new encoder fails, too, or again
  // within two seconds; then there are no more pictures.
  absl::StatusOr<std::span<const uint8_t>> code(const AtlasColors& colors, int64_t time_ns);
  // Codes the last atlas once more. Expects one.
  absl::StatusOr<std::span<const uint8_t>> codeAgain(int64_t time_ns);

 private:
  MovieCoder(const MovieCoding& coding, VideoEncoderChoice::Begun begun);
  absl::Status encode(Reference reference, int64_t time_ns);
  // By a new encoder, after the last one has failed.
  absl::Status encodeAnew(const absl::Status& failure, int64_t time_ns);

  TiledPicture picture_;
  const VideoFormat format_;
  const VideoEncoderChoicePtr encoders_;
  VideoEncoderKind kind_;
  std::unique_ptr<VideoEncoder> encoder_;  // null = it has failed for good
  absl::Status failure_;                   // why
  std::optional<int64_t> anew_ns_;  // time of the first picture of an encoder after the first
  bool has_coded_ = false;
  VideoPicture newest_;
  std::vector<uint8_t> access_unit_;
  bool needs_sync_ = true;
  int64_t sync_ns_ = 0;  // time of the last picture without a reference
};

}  // namespace viewloom
