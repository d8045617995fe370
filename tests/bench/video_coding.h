// SPDX-License-Identifier: Apache-2.0
// One atlas, packed and unpacked as server and client do it, in two ways.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "display/atlas_layout.h"
#include "encode/band_encoder.h"
#include "encode/video_encoders.h"
#include "lib/atlas.h"

namespace viewloom::bench {

// Figures of one atlas.
struct Coded {
  uint64_t bytes = 0;
  double psnr_db = 0;    // of luma
  double encode_ms = 0;  // CPU time of all threads
  double decode_ms = 0;  // the same, until RGB of the whole atlas
};

// Thread-safety: none.
class VideoCoding {
 public:
  // Pixels of a layout without a stack: uint32_t[row][column], red in the low byte.
  VideoCoding(const AtlasLayout& layout, std::vector<uint32_t> rgba);

  uint32_t pictureCount() const { return stacked_.stack->picture_count; }
  Coded asJpeg(uint32_t quality);
  Coded asVideo(uint32_t qp);

 private:
  Atlas emptyAtlas(const AtlasLayout& layout, const EncodingSpec& encoding) const;
  void finish(const Atlas& atlas, Coded& coded) const;

  AtlasLayout quilt_;
  AtlasLayout stacked_;
  std::vector<uint32_t> rgba_;           // of the quilt
  std::vector<uint8_t> quilt_planes_;    // as engines make them: Y'CbCr 4:2:0
  std::vector<uint8_t> stacked_planes_;  // the same
  BytePool bytes_{64};
  BytePool planes_{64};
  BandEncoder jpeg_{bytes_};
  VideoEncoders encoders_{1};
};

}  // namespace viewloom::bench
