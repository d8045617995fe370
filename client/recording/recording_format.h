// SPDX-License-Identifier: Apache-2.0
// How recordings lie in their files; client/watch.md writes it down for others. Little endian:
//   8 bytes "VIEWLOOM", uint32 version, uint32 kind, then records:
//   int64 ns since the recording began, uint32 length, so many bytes of a message.
// A record of length 0 is the last of a recording that was completed.
#pragma once

#include <array>
#include <cstdint>

namespace viewloom {

// The number in the file.
enum class RecordingKind : uint32_t {
  kFrames = 1,   // PublishFramesRequest: header and chunks
  kAtlases = 2,  // StreamAtlasesResponse
};

inline constexpr std::array<char, 8> kRecordingMagic = {'V', 'I', 'E', 'W', 'L', 'O', 'O', 'M'};
inline constexpr uint32_t kRecordingVersion = 1;
inline constexpr uint64_t kRecordingHeadBytes = 16;
inline constexpr uint64_t kRecordHeadBytes = 12;
inline constexpr uint32_t kRecordBytesMax = 4 << 20;  // no message on the wire is larger

}  // namespace viewloom
