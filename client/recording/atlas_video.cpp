// SPDX-License-Identifier: Apache-2.0
#include "recording/atlas_video.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_format.h"
#include "base/output_file.h"
#include "base/processor_count.h"
#include "base/str_cat.h"
#include "display/display_spec.h"
#include "display/quilt_json.h"
#include "lib/file_name_part.h"
#include "video/quantisation.h"

namespace viewloom {
namespace {

constexpr const char* kEnding = ".mp4";
constexpr uint32_t kThreadsMax = 4;

AtlasTiles tilesOf(const v1::AtlasLayout& layout) {
  return {.atlas_px = {layout.size().width(), layout.size().height()},
          .tile_px = {layout.tile_size().width(), layout.tile_size().height()},
          .columns = layout.columns(),
          .rows = layout.rows(),
          .padding_top_px = layout.padding_top_px()};
}

// Video keeps neither depth, nor pixels that each show another view. Panels are the displays with a
// cone whose picture is one view, not a quilt.
absl::Status checkPlayable(const v1::AtlasLayout& layout) {
  const auto refuse = [](std::string_view reason) {
    return absl::FailedPreconditionError(
        strCat("the display ", reason,
               "; accepted for a video are quilts, stereo pairs and cameras in one image"));
  };
  if (layout.has_depth_codes()) return refuse("has depth beside colour, which video would change");
  if (layout.view_cone_rad() > 0 && layout.suffix().empty()) {
    return refuse("is a panel whose pixels show different views, which video would mix");
  }
  if (layout.image_count() > 1) return refuse("has several images");
  if (isFileNamePart(layout.suffix()) || layout.suffix().empty()) return absl::OkStatus();
  return absl::FailedPreconditionError(
      "the server sent a name that cannot be part of a file name; no video is written");
}

// The error of the video is that of the atlases.
uint32_t qpOf(const v1::AtlasEncoding& encoding) {
  constexpr uint32_t kUsualQuality = 85;
  const bool is_video = encoding.color() == v1::BAND_ENCODING_H264;
  if (is_video && encoding.video_qp() > 0) {
    return std::clamp(encoding.video_qp(), kVideoQpMin, kVideoQpMax);
  }
  const uint32_t quality = encoding.jpeg_quality();
  return matchedVideoQp(quality == 0 ? kUsualQuality : std::min(quality, 100U));
}

std::string commentOf(const v1::AtlasLayout& layout) {
  if (layout.suffix().empty()) return "";
  return quiltJson({.view_count = layout.view_count(),
                    .columns = layout.columns(),
                    .rows = layout.rows(),
                    .aspect = layout.aspect()});
}

// "clip.mp4" with the suffix "_qs8x6a0.75" is "clip_qs8x6a0.75.mp4".
std::filesystem::path withSuffix(const std::filesystem::path& path, const std::string& suffix) {
  const std::string stem = path.stem().string();
  if (stem.ends_with(suffix)) return path;
  return path.parent_path() / (stem + suffix + path.extension().string());
}

}  // namespace

bool isVideoName(const std::filesystem::path& path) {
  return path.extension() == kEnding;
}

AtlasVideo::AtlasVideo(std::filesystem::path path, std::string title,
                       VideoEncoderChoicePtr encoders)
    : path_(std::move(path)),
      title_(std::move(title)),
      encoders_(std::move(encoders)),
      written_path_(path_) {}

absl::StatusOr<std::unique_ptr<AtlasVideo>> AtlasVideo::create(std::filesystem::path path,
                                                               std::string title,
                                                               VideoEncoderChoicePtr encoders) {
  if (!isVideoName(path)) {
    return absl::InvalidArgumentError(strCat(
        "\"", path.string(), "\": is no name of a video; accepted is a name that ends in .mp4"));
  }
  VIEWLOOM_RETURN_IF_ERROR(checkOutput(path));
  return std::unique_ptr<AtlasVideo>(
      new AtlasVideo(std::move(path), std::move(title), std::move(encoders)));
}

absl::Status AtlasVideo::begin(const v1::AtlasLayout& layout) {
  tiles_ = tilesOf(layout);
  const absl::StatusOr<VideoTiles> fitted = fitVideoTiles(tiles_, encoders_->limit());
  VIEWLOOM_RETURN_IF_ERROR(fitted.status());
  video_tiles_ = *fitted;
  auto coder = MovieCoder::make({.atlas = tiles_,
                                 .video = video_tiles_,
                                 .qp = qpOf(layout.encoding()),
                                 .thread_count = std::min(processorCount(), kThreadsMax),
                                 .encoders = encoders_});
  VIEWLOOM_RETURN_IF_ERROR(coder.status());
  written_path_ = withSuffix(path_, layout.suffix());
  auto file = MovieFile::create(
      written_path_, {.title = title_, .comment = commentOf(layout), .tool = "viewloom"});
  VIEWLOOM_RETURN_IF_ERROR(file.status());
  coder_ = *std::move(coder);
  file_ = *std::move(file);
  return absl::OkStatus();
}

absl::Status AtlasVideo::add(const Atlas& atlas, int64_t arrived_ns) {
  if (layout_ != atlas.layout) VIEWLOOM_RETURN_IF_ERROR(checkPlayable(*atlas.layout));
  layout_ = atlas.layout;
  if (!file_) VIEWLOOM_RETURN_IF_ERROR(begin(*layout_));
  if (tilesOf(*atlas.layout) != tiles_) {
    return absl::FailedPreconditionError(
        strCat(written_path_.string(), ": the atlases have changed from ", tiles_.atlas_px.width,
               "x", tiles_.atlas_px.height, " px to ", atlas.layout->size().width(), "x",
               atlas.layout->size().height(),
               " px or other views; the video ends here and keeps what came before"));
  }
  const absl::StatusOr<AtlasPicture> picture = decoder_.decode(atlas);
  VIEWLOOM_RETURN_IF_ERROR(picture.status());
  const v1::AtlasHeader& header = atlas.header;
  const int64_t shown_ns =
      header.shown_time_ns() != 0 ? header.shown_time_ns() : header.capture_time_ns();
  const int64_t time_ns = clock_.next(shown_ns, arrived_ns);
  const auto coded = coder_->code({.samples = picture->samples.data()}, time_ns);
  if (!coded.ok()) return ended(coded.status());
  const absl::Status added = file_->add(*coded, time_ns);
  return absl::IsInvalidArgument(added) ? ended(added) : added;
}

absl::Status AtlasVideo::ended(const absl::Status& failure) const {
  const std::string_view rest = pictureCount() > 0
                                    ? "; the video ends here and keeps what came before"
                                    : "; no video is written";
  return absl::Status(failure.code(),
                      strCat(written_path_.string(), ": ", failure.message(), rest));
}

absl::Status AtlasVideo::complete(int64_t now_ns) {
  if (!file_) {
    return absl::FailedPreconditionError(
        strCat(path_.string(), ": is not written, as no whole atlas came"));
  }
  end_ns_ = clock_.end(now_ns);
  return file_->complete(end_ns_);
}

std::string AtlasVideo::summary() const {
  const uint64_t count = pictureCount();
  const std::string scaling = scalingNote(tiles_, video_tiles_, encoders_->limit());
  const double seconds = static_cast<double>(end_ns_) * 1e-9;
  return strCat(written_path_.string(), ": ", count, count == 1 ? " picture" : " pictures", " of ",
                video_tiles_.picture_px.width, "x", video_tiles_.picture_px.height, " px in ",
                absl::StrFormat("%.1f", seconds), " s", scaling.empty() ? "" : "; ", scaling);
}

}  // namespace viewloom
