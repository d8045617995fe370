// SPDX-License-Identifier: Apache-2.0
#include "mp4/movie_fragments.h"

#include <array>

#include "base/check.h"

namespace viewloom {
namespace {

// Fragments whose offsets count from themselves came with "iso5".
constexpr std::array<std::string_view, 4> kFragmentBrands = {"iso5", "iso6", "avc1", "mp41"};
constexpr size_t kDataHeader_bytes = 8;

// Fields of sample_flags (8.8.3.1): whether it depends on others, and whether it is no sync sample.
constexpr uint32_t kDependsOnOthers = 1U << 24 | 1U << 16;
constexpr uint32_t kDependsOnNone = 2U << 24;

// The tables of samples, which fragments leave empty.
void writeEmptyTables(BoxWriter& out) {
  for (const std::string_view type : {"stts", "stsc", "stco"}) {
    out.addBox(type, [&] {
      out.addVersion(0);
      out.add32(0);
    });
  }
  out.addBox("stsz", [&] {
    out.addVersion(0);
    out.add32(0);
    out.add32(0);
  });
}

// TrackExtendsBox (8.8.3): fragments follow, and say everything themselves.
void writeExtends(BoxWriter& out) {
  out.addBox("mvex", [&] {
    out.addBox("trex", [&] {
      out.addVersion(0);
      out.add32(kMovieTrackId);
      out.add32(1);  // of the sample descriptions
      out.add32(0);
      out.add32(0);
      out.add32(0);
    });
  });
}

// TrackFragmentHeaderBox (8.8.7) and TrackFragmentBaseMediaDecodeTimeBox (8.8.12).
void writeTrackPlace(BoxWriter& out, uint64_t begin_ticks) {
  constexpr uint32_t kOffsetsFromFragment = 0x020000;
  out.addBox("tfhd", [&] {
    out.addVersion(0, kOffsetsFromFragment);
    out.add32(kMovieTrackId);
  });
  out.addBox("tfdt", [&] {
    out.addVersion(1);
    out.add64(begin_ticks);
  });
}

}  // namespace

std::vector<uint8_t> makeFragmentsHead(const AvcTrack& track, const MovieTags& tags) {
  BoxWriter out;
  FileTypeBox{.brands = kFragmentBrands}.write(out);
  out.addBox("moov", [&] {
    MovieHeaderBox{}.write(out);
    writeTrack(out, track, 0, [&] { writeEmptyTables(out); });
    writeExtends(out);
    UserDataBox{.tags = tags}.write(out);
  });
  return out.take();
}

std::vector<uint8_t> makeFragmentHead(const AvcSample& sample, const FragmentTimes& times) {
  // TrackRunBox (8.8.8): offset of the data, then duration, size and flags of each sample.
  constexpr uint32_t kRunFields = 0x000001 | 0x000100 | 0x000200 | 0x000400;
  VIEWLOOM_CHECK(sample.bytes.size() + kDataHeader_bytes <= UINT32_MAX);
  const auto sample_bytes = uint32_t(sample.bytes.size());
  BoxWriter out;
  size_t data_offset_place = 0;
  out.addBox("moof", [&] {
    out.addBox("mfhd", [&] {
      out.addVersion(0);
      out.add32(times.number);
    });
    out.addBox("traf", [&] {
      writeTrackPlace(out, times.begin_ticks);
      out.addBox("trun", [&] {
        out.addVersion(0, kRunFields);
        out.add32(1);
        data_offset_place = out.size();
        out.add32(0);
        out.add32(times.duration_ticks);
        out.add32(sample_bytes);
        out.add32(sample.is_sync ? kDependsOnNone : kDependsOnOthers);
      });
    });
  });
  out.set32(data_offset_place, uint32_t(out.size() + kDataHeader_bytes));
  out.add32(uint32_t(sample_bytes + kDataHeader_bytes));
  out.addText("mdat");
  return out.take();
}

}  // namespace viewloom
