// SPDX-License-Identifier: Apache-2.0
#include "mp4/movie_boxes.h"

#include <limits>

namespace viewloom {
namespace {

constexpr uint16_t kUndetermined = 0x55C4;  // "und": a language of three letters with 5 bits each
constexpr uint32_t kOne16 = 0x00010000;     // 1 as a number of 16.16 bits
constexpr uint32_t kDpi72 = 0x00480000;

// Times have 64 bits in version 1 of a box, and 32 bits in version 0.
uint8_t versionFor(uint64_t duration_ticks) {
  return duration_ticks > std::numeric_limits<uint32_t>::max() ? 1 : 0;
}

void addTime(BoxWriter& out, uint8_t version, uint64_t ticks) {
  if (version == 1) {
    out.add64(ticks);
  } else {
    out.add32(uint32_t(ticks));
  }
}

// Times of creation and of the last change: not said.
void addNoDates(BoxWriter& out, uint8_t version) {
  addTime(out, version, 0);
  addTime(out, version, 0);
}

void addIdentityMatrix(BoxWriter& out) {
  constexpr uint32_t kOne2 = 0x40000000;  // 1 as a number of 2.30 bits
  for (const uint32_t value : {kOne16, 0U, 0U, 0U, kOne16, 0U, 0U, 0U, kOne2}) out.add32(value);
}

// AVCDecoderConfigurationRecord (ISO 14496-15, 5.3.3).
void writeConfiguration(BoxWriter& out, const AvcTrack& track) {
  constexpr uint8_t kFirstProfileWithFormat = 100;  // High: it also tells chroma and depth
  constexpr uint8_t kReserved = 0xFC;
  const AvcParameterSets& sets = track.sets;
  const H264Parameters& parameters = track.parameters;
  out.addBox("avcC", [&] {
    out.add8(1);
    out.add8(parameters.profile);
    out.add8(parameters.constraints);
    out.add8(parameters.level);
    out.add8(kReserved | 3);  // lengths of 4 bytes
    out.add8(0xE0 | 1);       // one sequence parameter set
    out.add16(uint16_t(sets.sequence.size()));
    out.addBytes(sets.sequence);
    out.add8(1);
    out.add16(uint16_t(sets.picture.size()));
    out.addBytes(sets.picture);
    if (parameters.profile < kFirstProfileWithFormat) return;
    out.add8(kReserved | 1);  // 4:2:0
    out.add8(0xF8);           // 8 bits of luma
    out.add8(0xF8);           // and of chroma
    out.add8(0);              // no extensions of the sequence parameter set
  });
}

// ColourInformationBox (12.1.5), with the numbers of the parameter set.
void writeColor(BoxWriter& out, const H264Color& color) {
  constexpr uint8_t kFullRange = 0x80;
  out.addBox("colr", [&] {
    out.addText("nclx");
    out.add16(color.primaries);
    out.add16(color.transfer);
    out.add16(color.matrix);
    out.add8(color.is_full_range ? kFullRange : 0);
  });
}

void writeSampleEntry(BoxWriter& out, const AvcTrack& track) {
  constexpr size_t kCompressorName_bytes = 32;
  constexpr uint16_t kDepth = 0x18;
  constexpr uint16_t kMinusOne = 0xFFFF;
  out.addBox("avc1", [&] {
    out.addZeros(6);
    out.add16(1);  // of the data references
    out.addZeros(16);
    out.add16(uint16_t(track.parameters.size_px.width));
    out.add16(uint16_t(track.parameters.size_px.height));
    out.add32(kDpi72);
    out.add32(kDpi72);
    out.add32(0);
    out.add16(1);  // picture in a sample
    out.addZeros(kCompressorName_bytes);
    out.add16(kDepth);
    out.add16(kMinusOne);
    writeConfiguration(out, track);
    writeColor(out, track.parameters.color);
  });
}

void writeTag(BoxWriter& out, std::string_view type, std::string_view text) {
  constexpr uint32_t kUtf8 = 1;
  if (text.empty()) return;
  out.addBox(type, [&] {
    out.addBox("data", [&] {
      out.add32(kUtf8);
      out.add32(0);  // no country and language
      out.addText(text);
    });
  });
}

}  // namespace

void FileTypeBox::write(BoxWriter& out) const {
  constexpr uint32_t kMinorVersion = 0x200;
  out.addBox("ftyp", [&] {
    out.addText(brands.front());
    out.add32(kMinorVersion);
    for (const std::string_view brand : brands) out.addText(brand);
  });
}

void MovieHeaderBox::write(BoxWriter& out) const {
  constexpr uint16_t kFullVolume = 0x0100;
  const uint8_t version = versionFor(duration_ticks);
  out.addBox("mvhd", [&] {
    out.addVersion(version);
    addNoDates(out, version);
    out.add32(kMovieTicksPerSecond);
    addTime(out, version, duration_ticks);
    out.add32(kOne16);  // speed
    out.add16(kFullVolume);
    out.addZeros(10);
    addIdentityMatrix(out);
    out.addZeros(24);
    out.add32(kMovieTrackId + 1);  // of the next track
  });
}

void TrackHeaderBox::write(BoxWriter& out) const {
  constexpr uint32_t kEnabledInMovie = 3;
  const uint8_t version = versionFor(duration_ticks);
  out.addBox("tkhd", [&] {
    out.addVersion(version, kEnabledInMovie);
    addNoDates(out, version);
    out.add32(kMovieTrackId);
    out.add32(0);
    addTime(out, version, duration_ticks);
    out.addZeros(16);
    addIdentityMatrix(out);
    out.add32(size_px.width << 16);
    out.add32(size_px.height << 16);
  });
}

void MediaHeaderBox::write(BoxWriter& out) const {
  const uint8_t version = versionFor(duration_ticks);
  out.addBox("mdhd", [&] {
    out.addVersion(version);
    addNoDates(out, version);
    out.add32(kMovieTicksPerSecond);
    addTime(out, version, duration_ticks);
    out.add16(kUndetermined);
    out.add16(0);
  });
}

void VideoHandlerBox::write(BoxWriter& out) const {
  out.addBox("hdlr", [&] {
    out.addVersion(0);
    out.add32(0);
    out.addText("vide");
    out.addZeros(12);
    out.addText("viewloom");
    out.add8(0);
  });
}

void VideoMediaHeaderBox::write(BoxWriter& out) const {
  constexpr uint32_t kRequiredFlags = 1;
  out.addBox("vmhd", [&] {
    out.addVersion(0, kRequiredFlags);
    out.addZeros(8);  // copied to the screen as it is
  });
}

void DataInformationBox::write(BoxWriter& out) const {
  constexpr uint32_t kSameFile = 1;
  out.addBox("dinf", [&] {
    out.addBox("dref", [&] {
      out.addVersion(0);
      out.add32(1);
      out.addBox("url ", [&] { out.addVersion(0, kSameFile); });
    });
  });
}

void SampleDescriptionBox::write(BoxWriter& out) const {
  out.addBox("stsd", [&] {
    out.addVersion(0);
    out.add32(1);
    writeSampleEntry(out, track);
  });
}

void UserDataBox::write(BoxWriter& out) const {
  if (tags.title.empty() && tags.comment.empty() && tags.tool.empty()) return;
  out.addBox("udta", [&] {
    out.addBox("meta", [&] {
      out.addVersion(0);
      out.addBox("hdlr", [&] {
        out.addVersion(0);
        out.add32(0);
        out.addText("mdirappl");
        out.addZeros(9);
      });
      out.addBox("ilst", [&] {
        writeTag(out, "\xA9nam", tags.title);
        writeTag(out,
                 "\xA9"
                 "cmt",
                 tags.comment);
        writeTag(out, "\xA9too", tags.tool);
      });
    });
  });
}

}  // namespace viewloom
