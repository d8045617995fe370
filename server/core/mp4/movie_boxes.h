// SPDX-License-Identifier: Apache-2.0
// Boxes that files and live fragments share: the type of the file, and the description of its only
// track.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "mp4/avc_track.h"
#include "mp4/box_writer.h"

namespace viewloom {

// Ticks a second of all times in our files.
inline constexpr uint32_t kMovieTicksPerSecond = 90'000;
inline constexpr uint32_t kMovieTrackId = 1;

// Texts about a movie, in UTF-8. Empty ones are left out.
struct MovieTags {
  std::string title;
  std::string comment;  // of quilts: their layout, as quiltJson() writes it
  std::string tool;     // program that wrote it
};

// FileTypeBox (4.3). Brands have four characters; the first one is the major brand.
struct FileTypeBox {
  std::span<const std::string_view> brands;

  void write(BoxWriter& out) const;
};

// MovieHeaderBox (8.2.2). 0 ticks: the length is not known, because fragments follow.
struct MovieHeaderBox {
  uint64_t duration_ticks = 0;

  void write(BoxWriter& out) const;
};

// TrackHeaderBox (8.3.2).
struct TrackHeaderBox {
  uint64_t duration_ticks = 0;
  SizePx size_px;

  void write(BoxWriter& out) const;
};

// MediaHeaderBox (8.4.2).
struct MediaHeaderBox {
  uint64_t duration_ticks = 0;

  void write(BoxWriter& out) const;
};

// HandlerBox (8.4.3) of a track of video.
struct VideoHandlerBox {
  void write(BoxWriter& out) const;
};

// VideoMediaHeaderBox (12.1.2).
struct VideoMediaHeaderBox {
  void write(BoxWriter& out) const;
};

// DataInformationBox (8.7.1): all bytes are in the same file.
struct DataInformationBox {
  void write(BoxWriter& out) const;
};

// SampleDescriptionBox (8.5.2) with one AVCSampleEntry (ISO 14496-15, 5.4.2), which has the
// decoder's configuration and the colour.
struct SampleDescriptionBox {
  const AvcTrack& track;

  void write(BoxWriter& out) const;
};

// UserDataBox (8.10.1) with a list of tags as players and ffmpeg read it.
struct UserDataBox {
  const MovieTags& tags;

  void write(BoxWriter& out) const;
};

// TrackBox (8.3.1): the description, and the tables of its samples that `write_tables()` writes.
template <typename Tables>
void writeTrack(BoxWriter& out, const AvcTrack& track, uint64_t duration_ticks,
                const Tables& write_tables) {
  out.addBox("trak", [&] {
    TrackHeaderBox{.duration_ticks = duration_ticks, .size_px = track.parameters.size_px}.write(
        out);
    out.addBox("mdia", [&] {
      MediaHeaderBox{.duration_ticks = duration_ticks}.write(out);
      VideoHandlerBox{}.write(out);
      out.addBox("minf", [&] {
        VideoMediaHeaderBox{}.write(out);
        DataInformationBox{}.write(out);
        out.addBox("stbl", [&] {
          SampleDescriptionBox{.track = track}.write(out);
          write_tables();
        });
      });
    });
  });
}

}  // namespace viewloom
