// SPDX-License-Identifier: Apache-2.0
#include "files/picture_file.h"

#include <webp/decode.h>
#include <webp/demux.h>

#include <memory>
#include <vector>

#include "files/exif.h"
#include "files/file_bytes.h"
#include "files/icc_profile.h"

namespace viewloom::files {
namespace {

using Demuxer = std::unique_ptr<WebPDemuxer, void (*)(WebPDemuxer*)>;

// "EXIF" or "ICCP"; empty without such a chunk.
std::vector<uint8_t> chunkOf(const WebPDemuxer* demuxer, const char* name) {
  WebPChunkIterator chunk{};
  std::vector<uint8_t> bytes;
  if (WebPDemuxGetChunk(demuxer, name, 1, &chunk) != 0) {
    bytes.assign(chunk.chunk.bytes, chunk.chunk.bytes + chunk.chunk.size);
  }
  WebPDemuxReleaseChunkIterator(&chunk);
  return bytes;
}

}  // namespace

absl::StatusOr<Picture> decodeWebp(const std::string& name, std::span<const uint8_t> bytes) {
  WebPBitstreamFeatures features{};
  const VP8StatusCode found = WebPGetFeatures(bytes.data(), bytes.size(), &features);
  if (found == VP8_STATUS_NOT_ENOUGH_DATA) return refuseCutShort(name, "WebP");
  if (found != VP8_STATUS_OK) return refuseDamaged(name, "WebP", "it has no header");
  VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(name, features.width, features.height));
  if (features.has_animation != 0) {
    return refuseFile(name,
                      "is an animated WebP; accepted is a single picture: write its frames as "
                      "pictures first, for instance with webpmux -get frame");
  }
  const WebPData data{bytes.data(), bytes.size()};
  const Demuxer demuxer(WebPDemux(&data), &WebPDemuxDelete);
  if (demuxer == nullptr) return refuseCutShort(name, "WebP");
  Picture picture{.width_px = static_cast<uint32_t>(features.width),
                  .height_px = static_cast<uint32_t>(features.height),
                  .channels = features.has_alpha != 0 ? 4U : 3U,
                  .bits = 8,
                  .coding = codingOfIcc(chunkOf(demuxer.get(), "ICCP")),
                  .bytes = {}};
  picture.bytes.resize(picture.pixelCount() * picture.channels);
  const auto decode = picture.channels == 4 ? &WebPDecodeRGBAInto : &WebPDecodeRGBInto;
  const auto stride_bytes = static_cast<int>(picture.channels * picture.width_px);
  if (decode(bytes.data(), bytes.size(), picture.bytes.data(), picture.bytes.size(),
             stride_bytes) == nullptr) {
    return refuseDamaged(name, "WebP", "its samples cannot be decoded");
  }
  const std::vector<uint8_t> exif = chunkOf(demuxer.get(), "EXIF");
  return turned(std::move(picture), orientationOf(tiffOfExif(exif)));
}

}  // namespace viewloom::files
