// SPDX-License-Identifier: Apache-2.0
// Atlases as pictures of a video for players: tiles where the atlas has them, of even size, without
// padding, and small enough for the codec.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/status.h"
#include "frame/size.h"
#include "video/picture_limit.h"
#include "video/plane_scaler.h"
#include "video/video_picture.h"

namespace viewloom {

// Equal tiles of an atlas. The first one begins at the left, `padding_top_px` below the top.
struct AtlasTiles {
  SizePx atlas_px;
  SizePx tile_px;
  uint32_t columns = 1;
  uint32_t rows = 1;
  uint32_t padding_top_px = 0;

  bool operator==(const AtlasTiles&) const = default;
};

// Tiles of a video of an atlas.
struct VideoTiles {
  SizePx tile_px;     // even, at most those of the atlas
  SizePx picture_px;  // columns x rows of them

  bool operator==(const VideoTiles&) const = default;
};

// The largest tiles whose picture an encoder takes. INVALID_ARGUMENT unless there are tiles, and
// all lie inside of the atlas. RESOURCE_EXHAUSTED if there are too many of them.
absl::StatusOr<VideoTiles> fitVideoTiles(const AtlasTiles& atlas, const PictureLimit& limit = {});

// "the atlas of 3360x3360 px is scaled to 3072x3072 px, ...". Empty where tiles keep their size.
std::string scalingNote(const AtlasTiles& atlas, const VideoTiles& video,
                        const PictureLimit& limit = {});

// Colours of an atlas: uint8_t[height][width][channel_count] R, G, B, and with four channels one
// that is ignored. Borrowed.
struct AtlasColors {
  const uint8_t* samples = nullptr;
  uint32_t channel_count = 3;  // or 4
};

// Makes pictures of atlases of one form. Thread-safety: none.
class TiledPicture {
 public:
  // Expects what fitVideoTiles() has made of the atlas.
  TiledPicture(const AtlasTiles& atlas, const VideoTiles& video);

  // Bytes that one holds.
  static uint64_t memoryBytes(const AtlasTiles& atlas, const VideoTiles& video);

  // The result is valid until the next call.
  VideoPicture make(const AtlasColors& colors);

 private:
  // Planes of one tile of the atlas, or of the whole picture.
  struct Planes {
    explicit Planes(SizePx size_px);
    SizePx chromaSize() const { return {(size_px.width + 1) / 2, (size_px.height + 1) / 2}; }

    SizePx size_px;
    std::vector<uint8_t> y;
    std::vector<uint8_t> cb;
    std::vector<uint8_t> cr;
  };

  void takeTile(const AtlasColors& colors, uint32_t left_px, uint32_t top_px);
  void placeTile(uint32_t left_px, uint32_t top_px);

  const AtlasTiles atlas_;
  const VideoTiles video_;
  Planes tile_;
  Planes picture_;
  std::optional<PlaneScaler> luma_scaler_;  // none where tiles keep their size
  std::optional<PlaneScaler> chroma_scaler_;
};

}  // namespace viewloom
