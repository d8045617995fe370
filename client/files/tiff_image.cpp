// SPDX-License-Identifier: Apache-2.0
#include "files/picture_file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

#include "base/str_cat.h"
#include "files/file_bytes.h"
#include "files/icc_profile.h"
#include "files/stored_samples.h"
#include "files/tiff_stream.h"

namespace viewloom::files {
namespace {

// A whole picture of four 64-bit samples a px, and room for a strip's slack.
constexpr uint64_t kAllocationMax = kFileBytesMax * 2;

struct TiffHeader {
  uint32_t width_px = 0, height_px = 0;
  uint16_t bits = 1, channels = 1, format = SAMPLEFORMAT_UINT, photometric = PHOTOMETRIC_MINISBLACK;
  uint16_t planar = PLANARCONFIG_CONTIG, orientation = ORIENTATION_TOPLEFT;
  bool has_alpha = false, is_premultiplied = false;

  bool isRgb() const { return photometric == PHOTOMETRIC_RGB; }
  bool isGrey() const {
    return photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_MINISWHITE;
  }
  // Samples that are taken as they are stored; libtiff makes colour of others.
  bool isPlain() const { return (isRgb() || isGrey()) && bits >= 8 && bits % 8 == 0; }
};

TiffHeader headerOf(TIFF* tiff) {
  TiffHeader header;
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &header.width_px);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &header.height_px);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &header.bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &header.channels);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &header.format);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &header.planar);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_ORIENTATION, &header.orientation);
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &header.photometric);
  uint16_t extra_count = 0;
  const uint16_t* extra = nullptr;
  TIFFGetFieldDefaulted(tiff, TIFFTAG_EXTRASAMPLES, &extra_count, &extra);
  if (extra_count > 0) {
    header.is_premultiplied = extra[0] == EXTRASAMPLE_ASSOCALPHA;
    header.has_alpha = header.is_premultiplied || extra[0] == EXTRASAMPLE_UNASSALPHA;
  }
  return header;
}

// Copies blocks of samples, strips or tiles, into a picture.
class TiffSamples {
 public:
  TiffSamples(TIFF* tiff, const TiffHeader& header, Picture& picture)
      : tiff_(tiff), header_(header), picture_(picture) {
    type_.bytes = header.bits / 8U;
    type_.kind = header.format == SAMPLEFORMAT_IEEEFP ? NumberKind::kFloat
                 : header.format == SAMPLEFORMAT_INT  ? NumberKind::kSigned
                                                      : NumberKind::kUnsigned;
    type_.is_big_endian = std::endian::native == std::endian::big;  // libtiff swaps
  }

  bool read() {
    const bool is_tiled = TIFFIsTiled(tiff_) != 0;
    uint32_t block_width = header_.width_px, block_height = header_.height_px;
    if (is_tiled) {
      TIFFGetField(tiff_, TIFFTAG_TILEWIDTH, &block_width);
      TIFFGetField(tiff_, TIFFTAG_TILELENGTH, &block_height);
    } else {
      TIFFGetFieldDefaulted(tiff_, TIFFTAG_ROWSPERSTRIP, &block_height);
      block_height = std::min(block_height, header_.height_px);
    }
    if (block_width == 0 || block_height == 0) return false;
    const tmsize_t size = is_tiled ? TIFFTileSize(tiff_) : TIFFStripSize(tiff_);
    const bool is_apart = header_.planar == PLANARCONFIG_SEPARATE;
    // Samples that lie side by side in a block.
    stored_channels_ = is_apart ? 1 : header_.channels;
    if (size <= 0 || uint64_t(size) > kAllocationMax ||
        uint64_t(size) < uint64_t{block_width} * block_height * stored_channels_ * type_.bytes) {
      return false;
    }
    block_.resize(static_cast<size_t>(size));
    const uint32_t plane_count = is_apart ? picture_.channels : 1;
    for (uint32_t plane = 0; plane < plane_count; ++plane) {
      for (uint32_t y = 0; y < header_.height_px; y += block_height) {
        for (uint32_t x = 0; x < header_.width_px; x += block_width) {
          if (!readBlock(is_tiled, x, y, plane)) return false;
          copy(x, y, std::min(block_width, header_.width_px - x),
               std::min(block_height, header_.height_px - y), block_width, plane);
        }
      }
    }
    return true;
  }

 private:
  bool readBlock(bool is_tiled, uint32_t x, uint32_t y, uint32_t plane) {
    const auto sample = static_cast<uint16_t>(plane);
    const auto size = static_cast<tmsize_t>(block_.size());
    if (is_tiled) {
      return TIFFReadEncodedTile(tiff_, TIFFComputeTile(tiff_, x, y, 0, sample), block_.data(),
                                 size) >= 0;
    }
    return TIFFReadEncodedStrip(tiff_, TIFFComputeStrip(tiff_, y, sample), block_.data(), size) >=
           0;
  }

  void copy(uint32_t x0, uint32_t y0, uint32_t width, uint32_t height, uint32_t block_width,
            uint32_t plane) {
    const uint32_t channel_count = stored_channels_ == 1 ? 1 : picture_.channels;
    for (uint32_t y = 0; y < height; ++y) {
      for (uint32_t x = 0; x < width; ++x) {
        const size_t from = (size_t{y} * block_width + x) * stored_channels_;
        const size_t to = (size_t{y0 + y} * picture_.width_px + x0 + x) * picture_.channels + plane;
        for (uint32_t i = 0; i < channel_count; ++i) {
          storeSample(&block_[(from + i) * type_.bytes], type_, picture_, to + i);
        }
      }
    }
  }

  TIFF* tiff_;
  const TiffHeader& header_;
  Picture& picture_;
  SampleType type_;
  uint32_t stored_channels_ = 1;
  std::vector<uint8_t> block_;
};

// White is zero: codes the other way round. Floats have no white.
void turnRound(Picture& picture) {
  if (picture.bits == 32) return;
  for (uint8_t& byte : picture.bytes) byte = static_cast<uint8_t>(~byte);
}

absl::Status refuseTiff(const std::string& name, const TiffStream& stream) {
  const bool is_short = stream.error.find("Read error") != std::string::npos ||
                        stream.error.find("end of file") != std::string::npos ||
                        stream.error.find("not enough") != std::string::npos ||
                        stream.error.find("Not enough") != std::string::npos ||
                        stream.error.find("Can not read") != std::string::npos ||
                        stream.error.find("Cannot read TIFF") != std::string::npos;
  if (is_short) return refuseCutShort(name, "TIFF");
  return refuseDamaged(name, "TIFF", stream.error.empty() ? "no picture" : stream.error);
}

absl::StatusOr<Picture> readPlain(const std::string& name, const TiffStream& stream, TIFF* tiff,
                                  const TiffHeader& header) {
  const uint32_t color_count = header.isRgb() ? 3 : 1;
  const bool is_number = header.format == SAMPLEFORMAT_UINT || header.format == SAMPLEFORMAT_INT ||
                         header.format == SAMPLEFORMAT_IEEEFP || header.format == SAMPLEFORMAT_VOID;
  const uint32_t bytes = header.bits / 8U;
  const bool is_size = bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8;
  if (!is_number || !is_size || header.channels < color_count ||
      (bytes == 1 && header.format == SAMPLEFORMAT_IEEEFP)) {
    return refuseFile(name, strCat("is a TIFF of ", header.channels, " channels of ", header.bits,
                                   " bits; accepted are whole numbers and floats of 8, 16, "
                                   "32 and 64 bits: export it anew"));
  }
  Picture picture{.width_px = header.width_px,
                  .height_px = header.height_px,
                  .channels = color_count + (header.has_alpha ? 1 : 0),
                  .bits = 32,
                  .coding = {},
                  .bytes = {}};
  picture.channels = std::min<uint32_t>(picture.channels, header.channels);
  const bool is_whole = header.format == SAMPLEFORMAT_UINT || header.format == SAMPLEFORMAT_VOID;
  if (is_whole && bytes <= 2) picture.bits = header.bits;
  picture.coding.is_premultiplied = header.is_premultiplied;
  picture.bytes.resize(picture.pixelCount() * picture.pixelBytes());
  if (!TiffSamples(tiff, header, picture).read()) return refuseTiff(name, stream);
  if (header.photometric == PHOTOMETRIC_MINISWHITE) turnRound(picture);
  return picture;
}

// libtiff's own way to RGBA of 8 bits, rows from the top, not turned.
absl::StatusOr<Picture> readConverted(const std::string& name, const TiffStream& stream, TIFF* tiff,
                                      const TiffHeader& header) {
  Picture picture{.width_px = header.width_px,
                  .height_px = header.height_px,
                  .channels = 4,
                  .bits = 8,
                  .coding = {},
                  .bytes = {}};
  picture.coding.is_premultiplied = true;
  std::vector<uint32_t> abgr(picture.pixelCount());
  // Reads it as if it were upright: the tag is applied to all pictures alike.
  if (TIFFReadRGBAImageOriented(tiff, header.width_px, header.height_px, abgr.data(),
                                header.orientation, 1) == 0) {
    return refuseTiff(name, stream);
  }
  picture.channels = header.has_alpha ? 4 : 3;
  picture.bytes.reserve(picture.pixelCount() * picture.channels);
  for (const uint32_t pixel : abgr) {
    for (uint32_t i = 0; i < picture.channels; ++i) {
      picture.bytes.push_back(static_cast<uint8_t>(pixel >> (8 * i)));
    }
  }
  return picture;
}

}  // namespace

absl::StatusOr<Picture> decodeTiff(const std::string& name, std::span<const uint8_t> bytes,
                                   PictureUse use) {
  TiffStream stream{.bytes = bytes, .offset = 0, .error = {}};
  const TiffHandle tiff = openTiff(stream, kAllocationMax);
  if (tiff == nullptr) return refuseTiff(name, stream);
  const TiffHeader header = headerOf(tiff.get());
  VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(name, header.width_px, header.height_px));
  if (!header.isPlain() && use == PictureUse::kDepth) {
    return refuseFile(
        name, strCat("is a TIFF of ", header.bits, " bits and photometric ", header.photometric,
                     "; accepted as depth is grey of 8 bits and more: save "
                     "depth without a palette"));
  }
  absl::StatusOr<Picture> picture = header.isPlain()
                                        ? readPlain(name, stream, tiff.get(), header)
                                        : readConverted(name, stream, tiff.get(), header);
  if (!picture.ok()) return picture.status();
  uint32_t icc_count = 0;
  const uint8_t* icc = nullptr;
  if (TIFFGetField(tiff.get(), TIFFTAG_ICCPROFILE, &icc_count, &icc) != 0) {
    const bool is_premultiplied = picture->coding.is_premultiplied;
    picture->coding = codingOfIcc({icc, icc_count});
    picture->coding.is_premultiplied = is_premultiplied;
  }
  return turned(*std::move(picture), header.orientation);
}

}  // namespace viewloom::files
