// SPDX-License-Identifier: Apache-2.0
#include "mp4/movie_head.h"

#include <array>
#include <limits>

#include "base/check.h"

namespace viewloom {
namespace {

constexpr uint64_t kMax32 = std::numeric_limits<uint32_t>::max();
constexpr uint64_t kBoxHeader_bytes = 8;
constexpr uint64_t kLongBoxHeader_bytes = 16;
constexpr std::array<std::string_view, 4> kBrands = {"isom", "iso2", "avc1", "mp41"};

// Samples from one sync sample to the next. They stand together, and players seek to them.
struct Chunk {
  uint64_t offset_bytes = 0;  // from the first sample on
  uint32_t sample_count = 0;
};

std::vector<Chunk> chunksOf(std::span<const MovieSample> samples) {
  std::vector<Chunk> chunks;
  uint64_t offset_bytes = 0;
  for (const MovieSample& sample : samples) {
    if (sample.is_sync || chunks.empty()) chunks.push_back({.offset_bytes = offset_bytes});
    ++chunks.back().sample_count;
    offset_bytes += sample.size_bytes;
  }
  return chunks;
}

// Writes pairs of a count and a value, where equal values follow each other. The number of pairs
// stands before them.
class RunTable {
 public:
  explicit RunTable(BoxWriter& out) : out_(out), count_offset_(out.size()) { out.add32(0); }

  void add(uint32_t value) {
    if (run_ > 0 && value != value_) end();
    value_ = value;
    ++run_;
  }
  void finish() {
    if (run_ > 0) end();
    out_.set32(count_offset_, entry_count_);
  }

 private:
  void end() {
    out_.add32(run_);
    out_.add32(value_);
    ++entry_count_;
    run_ = 0;
  }

  BoxWriter& out_;
  const size_t count_offset_;
  uint32_t entry_count_ = 0;
  uint32_t value_ = 0;
  uint32_t run_ = 0;
};

// TimeToSampleBox (8.6.1.2).
void writeDurations(BoxWriter& out, std::span<const MovieSample> samples) {
  out.addBox("stts", [&] {
    out.addVersion(0);
    RunTable table(out);
    for (const MovieSample& sample : samples) table.add(sample.duration_ticks);
    table.finish();
  });
}

// SyncSampleBox (8.6.2). Samples count from 1.
void writeSyncSamples(BoxWriter& out, std::span<const MovieSample> samples) {
  out.addBox("stss", [&] {
    out.addVersion(0);
    const size_t count_offset = out.size();
    out.add32(0);
    uint32_t count = 0;
    for (size_t i = 0; i < samples.size(); ++i) {
      if (!samples[i].is_sync) continue;
      out.add32(uint32_t(i + 1));
      ++count;
    }
    out.set32(count_offset, count);
  });
}

// SampleToChunkBox (8.7.4): an entry for each run of chunks with equally many samples.
void writeSamplesOfChunks(BoxWriter& out, std::span<const Chunk> chunks) {
  out.addBox("stsc", [&] {
    out.addVersion(0);
    const size_t count_offset = out.size();
    out.add32(0);
    uint32_t count = 0;
    for (size_t i = 0; i < chunks.size(); ++i) {
      if (i > 0 && chunks[i].sample_count == chunks[i - 1].sample_count) continue;
      out.add32(uint32_t(i + 1));
      out.add32(chunks[i].sample_count);
      out.add32(1);  // of the sample descriptions
      ++count;
    }
    out.set32(count_offset, count);
  });
}

// SampleSizeBox (8.7.3).
void writeSampleSizes(BoxWriter& out, std::span<const MovieSample> samples) {
  out.addBox("stsz", [&] {
    out.addVersion(0);
    out.add32(0);
    out.add32(uint32_t(samples.size()));
    for (const MovieSample& sample : samples) out.add32(sample.size_bytes);
  });
}

// ChunkOffsetBox (8.7.5), from the beginning of the file.
void writeChunkOffsets(BoxWriter& out, std::span<const Chunk> chunks, uint64_t first_bytes,
                       bool is_large) {
  out.addBox(is_large ? "co64" : "stco", [&] {
    out.addVersion(0);
    out.add32(uint32_t(chunks.size()));
    for (const Chunk& chunk : chunks) {
      const uint64_t offset_bytes = first_bytes + chunk.offset_bytes;
      if (is_large) {
        out.add64(offset_bytes);
      } else {
        out.add32(uint32_t(offset_bytes));
      }
    }
  });
}

class HeadMaker {
 public:
  HeadMaker(const AvcTrack& track, const MovieTags& tags, std::span<const MovieSample> samples)
      : track_(track), tags_(tags), samples_(samples), chunks_(chunksOf(samples)) {
    for (const MovieSample& sample : samples) {
      duration_ticks_ += sample.duration_ticks;
      data_bytes_ += sample.size_bytes;
    }
  }

  std::vector<uint8_t> make() const {
    // The size of the head does not depend on the offsets in it, but on how wide they are.
    const uint64_t small_bytes = write(0, false).size();
    const bool is_large = small_bytes + data_bytes_ > kMax32;
    const uint64_t head_bytes = is_large ? write(0, true).size() : small_bytes;
    return write(head_bytes, is_large);
  }

 private:
  std::vector<uint8_t> write(uint64_t first_bytes, bool is_large) const {
    BoxWriter out;
    FileTypeBox{.brands = kBrands}.write(out);
    out.addBox("moov", [&] {
      MovieHeaderBox{.duration_ticks = duration_ticks_}.write(out);
      writeTrack(out, track_, duration_ticks_, [&] {
        writeDurations(out, samples_);
        writeSyncSamples(out, samples_);
        writeSamplesOfChunks(out, chunks_);
        writeSampleSizes(out, samples_);
        writeChunkOffsets(out, chunks_, first_bytes, is_large);
      });
      UserDataBox{.tags = tags_}.write(out);
    });
    addMediaHeader(out);
    return out.take();
  }

  // The header of the MediaDataBox (8.1.1).
  void addMediaHeader(BoxWriter& out) const {
    const bool is_long = data_bytes_ + kBoxHeader_bytes > kMax32;
    out.add32(is_long ? 1 : uint32_t(data_bytes_ + kBoxHeader_bytes));
    out.addText("mdat");
    if (is_long) out.add64(data_bytes_ + kLongBoxHeader_bytes);
  }

  const AvcTrack& track_;
  const MovieTags& tags_;
  const std::span<const MovieSample> samples_;
  const std::vector<Chunk> chunks_;
  uint64_t duration_ticks_ = 0;
  uint64_t data_bytes_ = 0;
};

}  // namespace

std::vector<uint8_t> makeMovieHead(const AvcTrack& track, const MovieTags& tags,
                                   std::span<const MovieSample> samples) {
  VIEWLOOM_CHECK(!samples.empty());
  return HeadMaker(track, tags, samples).make();
}

}  // namespace viewloom
