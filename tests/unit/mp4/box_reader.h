// SPDX-License-Identifier: Apache-2.0
// Reads MP4 files for tests, from the standard alone: it shares no code with the writer.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace viewloom::test {

using Bytes = std::span<const uint8_t>;

inline uint64_t bigEndian(Bytes bytes, size_t offset, size_t count) {
  if (offset + count > bytes.size()) throw std::runtime_error("a box ends too early");
  uint64_t value = 0;
  for (size_t i = 0; i < count; ++i) value = value << 8 | bytes[offset + i];
  return value;
}

struct Box {
  std::string type;
  Bytes content;
  uint64_t begin = 0;          // of its header, in the file
  uint64_t content_begin = 0;  // in the file

  uint64_t number(size_t offset, size_t count) const { return bigEndian(content, offset, count); }
  uint8_t version() const { return uint8_t(number(0, 1)); }
};

// Boxes of some bytes that begin at `begin` of a file. The last one may be cut short where
// `cut_is_fine`, as media data that was not made.
inline std::vector<Box> boxesOf(Bytes bytes, uint64_t begin = 0, bool cut_is_fine = false) {
  std::vector<Box> boxes;
  for (size_t at = 0; at < bytes.size();) {
    uint64_t size = bigEndian(bytes, at, 4);
    const std::string type(bytes.begin() + long(at) + 4, bytes.begin() + long(at) + 8);
    size_t header = 8;
    if (size == 1) {
      size = bigEndian(bytes, at + 8, 8);
      header = 16;
    }
    if (size < header) throw std::runtime_error("a box of type " + type + " is too small");
    if (at + size > bytes.size()) {
      if (!cut_is_fine) throw std::runtime_error("a box of type " + type + " is too large");
      size = bytes.size() - at;
    }
    boxes.push_back({.type = type,
                     .content = bytes.subspan(at + header, size - header),
                     .begin = begin + at,
                     .content_begin = begin + at + header});
    at += size;
  }
  return boxes;
}

// The box at a path such as "moov/trak/tkhd"; its first steps lead through plain boxes. `skipped`:
// bytes of fields before the boxes inside of the last parent.
inline std::optional<Box> findBox(Bytes file, const std::string& path, size_t skipped = 0) {
  const size_t slash = path.find('/');
  for (const Box& box : boxesOf(file, 0, true)) {
    if (box.type != path.substr(0, slash)) continue;
    if (slash == std::string::npos) return box;
    const std::string rest = path.substr(slash + 1);
    const bool is_last_parent = rest.find('/') == std::string::npos;
    return findBox(box.content.subspan(is_last_parent ? skipped : 0), rest, skipped);
  }
  return std::nullopt;
}

inline Box boxAt(Bytes file, const std::string& path, size_t skipped = 0) {
  const auto box = findBox(file, path, skipped);
  if (!box) throw std::runtime_error("there is no box " + path);
  return *box;
}

struct ReadSample {
  uint64_t offset = 0;
  uint64_t size = 0;
  uint64_t begin_ticks = 0;
  uint64_t duration_ticks = 0;
  bool is_sync = false;
};

// All samples of a file whose index is in its `moov`, by its tables.
inline std::vector<ReadSample> samplesOf(Bytes file) {
  const std::string tables = "moov/trak/mdia/minf/stbl/";
  std::vector<ReadSample> samples;
  const Box sizes = boxAt(file, tables + "stsz");
  for (size_t i = 0; i < sizes.number(8, 4); ++i) {
    samples.push_back({.size = sizes.number(12 + 4 * i, 4)});
  }
  const Box times = boxAt(file, tables + "stts");
  uint64_t begin_ticks = 0;
  size_t next = 0;
  for (size_t entry = 0; entry < times.number(4, 4); ++entry) {
    for (uint64_t i = 0; i < times.number(8 + 8 * entry, 4); ++i) {
      ReadSample& sample = samples.at(next++);
      sample.begin_ticks = begin_ticks;
      sample.duration_ticks = times.number(12 + 8 * entry, 4);
      begin_ticks += sample.duration_ticks;
    }
  }
  if (next != samples.size()) throw std::runtime_error("some samples have no time");
  const Box sync = boxAt(file, tables + "stss");
  for (size_t i = 0; i < sync.number(4, 4); ++i) {
    samples.at(sync.number(8 + 4 * i, 4) - 1).is_sync = true;
  }
  const bool is_large = findBox(file, tables + "co64").has_value();
  const Box offsets = boxAt(file, tables + (is_large ? "co64" : "stco"));
  const Box runs = boxAt(file, tables + "stsc");
  const size_t offset_bytes = is_large ? 8 : 4;
  next = 0;
  uint64_t in_chunk = 0;
  for (size_t chunk = 0, run = 0; chunk < offsets.number(4, 4); ++chunk) {
    if (run < runs.number(4, 4) && runs.number(8 + 12 * run, 4) == chunk + 1) {
      in_chunk = runs.number(12 + 12 * run++, 4);
    }
    uint64_t at = offsets.number(8 + offset_bytes * chunk, offset_bytes);
    for (uint64_t i = 0; i < in_chunk; ++i) {
      samples.at(next).offset = at;
      at += samples.at(next++).size;
    }
  }
  if (next != samples.size()) throw std::runtime_error("some samples have no place");
  return samples;
}

// A sample with lengths as Annex B, behind the parameter sets of the file.
inline std::vector<uint8_t> annexB(Bytes sample, const std::vector<Bytes>& sets) {
  std::vector<uint8_t> stream;
  const auto add = [&](Bytes unit) {
    stream.insert(stream.end(), {0, 0, 0, 1});
    stream.insert(stream.end(), unit.begin(), unit.end());
  };
  for (const Bytes set : sets) add(set);
  for (size_t at = 0; at < sample.size();) {
    const size_t size = bigEndian(sample, at, 4);
    if (at + 4 + size > sample.size()) throw std::runtime_error("a unit is too large");
    add(sample.subspan(at + 4, size));
    at += 4 + size;
  }
  return stream;
}

// The sample entry of the track: "avc1", and the boxes in it.
inline Box sampleEntry(Bytes file) {
  return boxAt(file, "moov/trak/mdia/minf/stbl/stsd/avc1", 8);
}
inline Box entryBox(Bytes file, const std::string& type) {
  constexpr size_t kVisualSampleEntry_bytes = 78;
  for (const Box& box : boxesOf(sampleEntry(file).content.subspan(kVisualSampleEntry_bytes))) {
    if (box.type == type) return box;
  }
  throw std::runtime_error("there is no " + type);
}

// Sequence and picture parameter set of the file.
inline std::vector<Bytes> setsOf(Bytes file) {
  const Box configuration = entryBox(file, "avcC");
  const size_t sequence_bytes = configuration.number(6, 2);
  const size_t picture_bytes = configuration.number(8 + sequence_bytes + 1, 2);
  return {configuration.content.subspan(8, sequence_bytes),
          configuration.content.subspan(8 + sequence_bytes + 3, picture_bytes)};
}

// Text of a tag in moov/udta/meta/ilst; "" if there is none.
inline std::string tagOf(Bytes file, const std::string& type) {
  const auto user = findBox(file, "moov/udta");
  if (!user) return "";
  for (const Box& meta : boxesOf(user->content)) {
    for (const Box& list : boxesOf(meta.content.subspan(4))) {
      if (list.type != "ilst") continue;
      for (const Box& tag : boxesOf(list.content)) {
        if (tag.type != type) continue;
        const Bytes text = boxesOf(tag.content).at(0).content.subspan(8);
        return {text.begin(), text.end()};
      }
    }
  }
  return "";
}

}  // namespace viewloom::test
