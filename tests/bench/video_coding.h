// SPDX-License-Identifier: Apache-2.0
// One atlas, packed and unpacked as server and client do it, in several ways.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "display/atlas_layout.h"
#include "encode/band_encoder.h"
#include "encode/video_chain.h"
#include "encode/video_encoders.h"
#include "lib/atlas.h"
#include "lib/color_decoder.h"
#include "pipeline/video_atlas.h"
#include "video/openh264_decoder.h"

namespace viewloom::bench {

// Figures of one atlas.
struct Coded {
  uint64_t bytes = 0;
  double psnr_db = 0;    // of luma
  double encode_ms = 0;  // CPU time of all threads
  double decode_ms = 0;  // the same, until RGB of the whole atlas
  // CPU time of OpenH264 alone, without colours, for video: no decoder with it takes less.
  double library_ms = 0;
};

// Throws std::runtime_error where there is no memory for one.
std::unique_ptr<OpenH264Decoder> bareDecoder();

// Server and client of chained video, between two atlases. Thread-safety: none.
struct ChainEnds {
  std::shared_ptr<VideoChain> coder = std::make_shared<VideoChain>();
  ColorDecoder decoder;
  std::unique_ptr<OpenH264Decoder> library = bareDecoder();
  uint64_t sequence = 0;  // of the last atlas; 0 = none
};

// Thread-safety: none.
class VideoCoding {
 public:
  // Pixels of a layout without a stack: uint32_t[row][column], red in the low byte.
  VideoCoding(const AtlasLayout& layout, std::vector<uint32_t> rgba);

  uint32_t pictureCount() const { return stacked_.layout.stack->picture_count; }
  Coded asJpeg(uint32_t quality);
  Coded asVideo(uint32_t qp);
  // Codes it as the next atlas of a chain. The first needs no other.
  Coded asChained(uint32_t qp, ChainEnds& chain);

 private:
  // The views in a stack, as engines make them: Y'CbCr 4:2:0.
  struct Stacked {
    AtlasLayout layout;
    std::vector<uint8_t> planes;
  };

  Stacked stackedViews() const;
  Atlas codePictures(const EncodingSpec& encoding, VideoStart start, PictureOrder order,
                     Coded& coded);
  Atlas emptyAtlas(const AtlasLayout& layout, const EncodingSpec& encoding) const;
  void finish(const Atlas& atlas, ColorDecoder& decoder, Coded& coded) const;
  void measureLibrary(const Atlas& atlas, OpenH264Decoder& library, Coded& coded) const;

  AtlasLayout quilt_;
  std::vector<uint32_t> rgba_;         // of the quilt
  std::vector<uint8_t> quilt_planes_;  // as engines make them: Y'CbCr 4:2:0
  Stacked stacked_;
  BytePool bytes_{64};
  BytePool planes_{64};
  BandEncoder jpeg_{bytes_};
  VideoEncoders encoders_{1};
};

}  // namespace viewloom::bench
