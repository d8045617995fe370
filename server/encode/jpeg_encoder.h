// SPDX-License-Identifier: Apache-2.0
// Packs colour bands as pieces of one baseline JPEG per image.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/byte_pool.h"
#include "encode/band_pixels.h"
#include "jpeg/jpeg_memory.h"

namespace viewloom {

// A restart marker after every MCU row and standard Huffman tables make rows independent of each
// other. A band is 8 MCU rows, so that the restart numbering (modulo 8) is the same in every band:
// the header of the whole image + bands joined by RST7 + EOI is what encoding the image at once
// would give, to the byte. Each band but the last carries its RST7, the first the header, the last
// the EOI. Slices of a band are whole MCU rows, with their restart markers numbered as in the band.
// Thread-safety: none; one thread at a time.
class JpegEncoder {
 public:
  explicit JpegEncoder(BytePool& pool);
  ~JpegEncoder();
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  // pixels.plane is kColor, or a channel of it, which makes a grey JPEG. Samples that are Y'CbCr
  // already are taken as they are. The first band of a quilt says how its views lie (quilt_exif.h).
  // A band, or a slice of one.
  SharedBytes encode(const BandPixels& pixels, const EncodingSpec& encoding,
                     const AtlasLayout& layout);

 private:
  // libjpeg's view of stream_: grows it when it is full.
  struct Destination : jpeg_destination_mgr {
    std::vector<uint8_t>* stream;
  };
  static void growStream(Destination& destination);

  void writeRgba(const BandPixels& pixels);
  void writeChannel(const BandPixels& pixels);
  void writePlanes(const BandPixels& pixels);
  // Fills stream_ with the band as a JPEG of its own; returns its length.
  size_t compress(const BandPixels& pixels, const EncodingSpec& encoding);

  BytePool& pool_;
  jpeg_error_mgr errors_;
  jpeg_compress_struct compressor_;
  std::unique_ptr<JpegMemory> memory_;
  Destination destination_;
  std::vector<uint8_t> stream_;  // never shrinks
  std::vector<uint8_t> channel_row_;
};

}  // namespace viewloom
