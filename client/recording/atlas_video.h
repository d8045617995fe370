// SPDX-License-Identifier: Apache-2.0
// Atlases as an MP4 file for players of quilts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/status.h"
#include "lib/atlas.h"
#include "lib/color_decoder.h"
#include "mp4/movie_clock.h"
#include "mp4/movie_coder.h"
#include "mp4/movie_file.h"

namespace viewloom {

// Whether the name ends in ".mp4".
bool isVideoName(const std::filesystem::path& path);

// The tiles lie as in the atlas. The file's name and its metadata say how: "clip.mp4" becomes
// "clip_qs8x6a0.75.mp4". Atlases larger than the encoder takes are scaled. Without complete(),
// nothing is left behind. Thread-safety: none; one owner at a time.
class AtlasVideo {
 public:
  // `title`: for the metadata, such as the name of the stream. INVALID_ARGUMENT if the name does
  // not end in ".mp4", or no file can be written there.
  static absl::StatusOr<std::unique_ptr<AtlasVideo>> create(
      std::filesystem::path path, std::string title,
      VideoEncoderChoicePtr encoders = VideoEncoderChoice::openH264());

  // The next atlas, which came at that time of a monotonic clock. Takes as long as coding does.
  // FAILED_PRECONDITION if the atlas is for no player, such as that of a panel or one of another
  // size than the first, and if the disk takes no more. RESOURCE_EXHAUSTED if memory is missing, or
  // for more views than a video holds. DATA_LOSS for an atlas that does not decode,
  // INVALID_ARGUMENT for one that does not hold its views. INTERNAL if the encoder fails, and a new
  // one too (MovieCoder). complete() keeps what came before an error.
  absl::Status add(const Atlas& atlas, int64_t arrived_ns);
  // The end of the last picture. Errors as MovieFile::complete. Call once.
  absl::Status complete(int64_t now_ns);

  uint64_t pictureCount() const { return file_ ? file_->pictureCount() : 0; }
  // "clip_qs8x6a0.75.mp4: 120 pictures of 3072x3072 px in 4.0 s; the atlas of ... is scaled to
  // ...". Only after complete().
  std::string summary() const;

 private:
  AtlasVideo(std::filesystem::path path, std::string title, VideoEncoderChoicePtr encoders);
  absl::Status begin(const v1::AtlasLayout& layout);
  // Error with which the video ends.
  absl::Status ended(const absl::Status& failure) const;

  const std::filesystem::path path_;  // as it was asked for
  const std::string title_;
  const VideoEncoderChoicePtr encoders_;
  std::filesystem::path written_path_;             // with the layout in its name
  std::shared_ptr<const v1::AtlasLayout> layout_;  // the newest that was looked at
  AtlasTiles tiles_;
  VideoTiles video_tiles_;
  ColorDecoder decoder_;
  std::unique_ptr<MovieFile> file_;  // from the first atlas on, as what follows
  std::unique_ptr<MovieCoder> coder_;
  MovieClock clock_;
  int64_t end_ns_ = 0;
};

}  // namespace viewloom
