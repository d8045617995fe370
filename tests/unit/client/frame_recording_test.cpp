// SPDX-License-Identifier: Apache-2.0
// Recordings of frames: there and back, cut short anywhere, and from hostile hands.
#include "recording/frame_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "lib/frame_messages.h"
#include "support/large_allocations.h"
#include "unit/client/test_files.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom::frame_recording_test {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

// A frame of two planes. A large first plane is longer than a chunk.
WireFrame makeFrame(uint64_t number, size_t first_bytes = 5000) {
  WireFrame frame;
  frame.header.set_number(number);
  frame.header.set_capture_time_ns(static_cast<int64_t>(number) * 1000);
  v1::Layer& layer = *frame.header.add_sources()->add_layers();
  for (const size_t size : {first_bytes, size_t{10}}) {
    std::vector<uint8_t> bytes(size);
    std::iota(bytes.begin(), bytes.end(), static_cast<uint8_t>(number));
    layer.add_planes()->set_bytes_count(size);
    frame.planes.push_back(std::make_shared<const std::vector<uint8_t>>(std::move(bytes)));
  }
  return frame;
}

void expectEqual(const WireFrame& a, const WireFrame& b) {
  EXPECT_EQ(a.header.SerializeAsString(), b.header.SerializeAsString());
  ASSERT_EQ(a.planes.size(), b.planes.size());
  for (size_t p = 0; p < a.planes.size(); ++p) EXPECT_EQ(*a.planes[p], *b.planes[p]);
}

class FrameRecordingTest : public testing::Test {
 protected:
  // Frames 1, 2, ..., 40 ms from each other.
  fs::path recordFrames(uint64_t count, size_t first_bytes = 5000) {
    const fs::path file = folder_.path() / "frames.vlr";
    auto recorder = FrameRecorder::create(file, clock_);
    EXPECT_TRUE(recorder.ok()) << recorder.status();
    for (uint64_t number = 1; number <= count; ++number) {
      EXPECT_EQ((*recorder)->add(makeFrame(number, first_bytes)), absl::OkStatus());
      clock_.advance(40'000'000);
    }
    EXPECT_EQ((*recorder)->complete(), absl::OkStatus());
    return file;
  }

  std::vector<RecordedFrame> readAll(const fs::path& file, bool* is_cut_short = nullptr) {
    std::vector<RecordedFrame> frames;
    const auto reader = FrameRecordingReader::open(file);
    EXPECT_TRUE(reader.ok()) << reader.status();
    if (!reader.ok()) return frames;
    for (;;) {
      auto frame = (*reader)->next();
      EXPECT_TRUE(frame.ok()) << frame.status();
      if (!frame.ok() || !frame->has_value()) break;
      frames.push_back(**std::move(frame));
    }
    if (is_cut_short != nullptr) *is_cut_short = (*reader)->isCutShort();
    return frames;
  }

  std::string refusalOf(const std::string& bytes) {
    const auto reader = FrameRecordingReader::open(folder_.write("bad.vlr", bytes));
    if (!reader.ok()) return std::string(reader.status().message());
    for (;;) {
      const auto frame = (*reader)->next();
      if (!frame.ok()) return std::string(frame.status().message());
      if (!frame->has_value()) return "";
    }
  }

  files::TestFolder folder_;
  ManualClock clock_;
};

TEST_F(FrameRecordingTest, givesFramesBackWithTheirTimes) {
  bool is_cut_short = true;
  const std::vector<RecordedFrame> frames = readAll(recordFrames(3, 2'500'000), &is_cut_short);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_FALSE(is_cut_short);
  for (size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].time_ns, static_cast<int64_t>(i) * 40'000'000);
    expectEqual(frames[i].frame, makeFrame(i + 1, 2'500'000));
  }
}

// The file by hand, from the words of client/watch.md.
std::string number(uint64_t value, size_t byte_count) {
  std::string bytes;
  for (size_t i = 0; i < byte_count; ++i) bytes.push_back(static_cast<char>(value >> (8 * i)));
  return bytes;
}

std::string record(uint64_t time_ns, const std::string& message) {
  return number(time_ns, 8) + number(message.size(), 4) + message;
}

std::string head(uint32_t version = 1, uint32_t kind = 1) {
  return "VIEWLOOM" + number(version, 4) + number(kind, 4);
}

// Messages as the Protocol Buffers library writes them. Each plane must fit in one chunk.
std::vector<std::string> messagesOf(const WireFrame& frame) {
  v1::PublishFramesRequest header;
  *header.mutable_header() = frame.header;
  std::vector<std::string> messages{header.SerializeAsString()};
  for (size_t plane = 0; plane < frame.planes.size(); ++plane) {
    v1::PublishFramesRequest request;
    request.mutable_chunk()->set_plane_index(static_cast<uint32_t>(plane));
    request.mutable_chunk()->set_data(frame.planes[plane]->data(), frame.planes[plane]->size());
    messages.push_back(request.SerializeAsString());
  }
  return messages;
}

TEST_F(FrameRecordingTest, liesInTheFileAsWrittenDown) {
  std::string expected = head();
  for (const std::string& message : messagesOf(makeFrame(1))) expected += record(0, message);
  for (const std::string& message : messagesOf(makeFrame(2))) {
    expected += record(40'000'000, message);
  }
  expected += record(40'000'000, "");
  EXPECT_EQ(files::bytesOf(recordFrames(2)), expected);
}

TEST_F(FrameRecordingTest, givesTheWholeFramesOfEveryPartOfAFile) {
  const fs::path whole = recordFrames(3, 60);
  const std::string bytes = files::bytesOf(whole);
  size_t frame_bytes = 0;
  for (const std::string& message : messagesOf(makeFrame(1, 60))) {
    frame_bytes += record(0, message).size();
  }
  for (size_t count = 16; count < bytes.size(); ++count) {
    bool is_cut_short = false;
    const auto frames = readAll(folder_.truncated(whole, count), &is_cut_short);
    ASSERT_TRUE(is_cut_short) << count;
    ASSERT_EQ(frames.size(), (count - 16) / frame_bytes) << count;
  }
  for (size_t count = 0; count < 16; ++count) {
    EXPECT_THAT(refusalOf(bytes.substr(0, count)), HasSubstr("is no recording")) << count;
  }
}

TEST_F(FrameRecordingTest, startsAgainAfterRewind) {
  const auto reader = FrameRecordingReader::open(recordFrames(2));
  ASSERT_TRUE(reader.ok());
  for (int round = 0; round < 2; ++round) {
    EXPECT_TRUE((*reader)->next()->has_value());
    EXPECT_EQ((**(*reader)->next()).frame.header.number(), 2U);
    EXPECT_FALSE((*reader)->next()->has_value());
    (*reader)->rewind();
  }
}

TEST_F(FrameRecordingTest, keepsAFrameOnceThatIsSentAgain) {
  const fs::path file = folder_.path() / "again.vlr";
  const auto recorder = FrameRecorder::create(file, clock_);
  ASSERT_TRUE(recorder.ok());
  for (const uint64_t frame : {1, 2, 2, 3}) {
    ASSERT_EQ((*recorder)->add(makeFrame(frame)), absl::OkStatus());
  }
  ASSERT_EQ((*recorder)->complete(), absl::OkStatus());
  EXPECT_EQ((*recorder)->frameCount(), 3U);
  EXPECT_EQ(readAll(file).size(), 3U);
}

TEST_F(FrameRecordingTest, leavesNothingBehindUnlessItIsComplete) {
  const fs::path file = recordFrames(1);
  const std::string old = files::bytesOf(file);
  {
    const auto recorder = FrameRecorder::create(file, clock_);
    ASSERT_TRUE(recorder.ok());
    ASSERT_EQ((*recorder)->add(makeFrame(1)), absl::OkStatus());
  }
  EXPECT_EQ(files::bytesOf(file), old);
  const auto empty = FrameRecorder::create(folder_.path() / "empty.vlr", clock_);
  ASSERT_TRUE(empty.ok());
  EXPECT_THAT(std::string((*empty)->complete().message()), HasSubstr("nothing whole"));
}

TEST_F(FrameRecordingTest, endsBehindTheLastWholeMessageOfItsOwner) {
  const fs::path file = folder_.path() / "part.vlr";
  auto writer = RecordingWriter::create(file, RecordingKind::kFrames);
  ASSERT_TRUE(writer.ok());
  takeFrameMessages(makeFrame(1), [&](const FrameMessage& message) {
    return (*writer)->add(0, message.head, message.data).ok();
  });
  (*writer)->markWhole();
  v1::PublishFramesRequest header;
  *header.mutable_header() = makeFrame(2).header;
  ASSERT_EQ((*writer)->add(5, header), absl::OkStatus());
  ASSERT_EQ((*writer)->complete(), absl::OkStatus());
  bool is_cut_short = true;
  EXPECT_EQ(readAll(file, &is_cut_short).size(), 1U);
  EXPECT_FALSE(is_cut_short);
  writer->reset();
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 1);
}

TEST_F(FrameRecordingTest, saysThatItsPlaceCannotBeWritten) {
  const auto recorder = FrameRecorder::create(folder_.path() / "none" / "frames.vlr", clock_);
  EXPECT_THAT(std::string(recorder.status().message()), HasSubstr("frames.vlr: cannot be written"));
}

TEST_F(FrameRecordingTest, refusesWhatNoWriterWritesWithItsPlace) {
  const std::vector<std::string> messages = messagesOf(makeFrame(1));
  const std::string header = record(0, messages[0]);
  const std::string chunk = record(0, messages[1]);
  v1::PublishFramesRequest empty_plane;
  *empty_plane.mutable_header() = makeFrame(1).header;
  empty_plane.mutable_header()
      ->mutable_sources(0)
      ->mutable_layers(0)
      ->mutable_planes(0)
      ->set_bytes_count(0);
  const struct {
    std::string bytes;
    const char* reason;
  } cases[] = {
      {"a picture, or what else there is", "is no recording"},
      {head(2), "is a recording of version 2; accepted is 1"},
      {head(1, 2), "is a recording of atlases"},
      {head() + record(0, "\xff\xff"), "has no header of a frame where one must come, at byte 16"},
      {head() + chunk, "has no header"},
      {head() + header + header + chunk, "lacks the piece of plane 0 from its byte 0"},
      {head() + header + chunk + chunk, "lacks the piece of plane 1"},
      {head() + record(0, empty_plane.SerializeAsString()), "declares a plane of 0 bytes"},
      {head() + number(0, 8) + number((4 << 20) + 1, 4) + std::string(100, 'x'),
       "has a message of 4194305 bytes, accepted are up to 4194304"},
      {head() + record(9, messages[0]) + chunk, "has the time 0 ns after 9 at byte "},
      {head() + record(uint64_t{1} << 63, messages[0]), "has the time -9223372036854775808"},
      {head() + record(0, "") + "more", "has 4 bytes after its end"},
  };
  for (const auto& bad : cases) EXPECT_THAT(refusalOf(bad.bytes), HasSubstr(bad.reason));
  EXPECT_THAT(std::string(FrameRecordingReader::open("nowhere.vlr").status().message()),
              HasSubstr("nowhere.vlr: no such file"));
}

TEST_F(FrameRecordingTest, takesNoMemoryForWhatTheFileDoesNotHave) {
  if (!test::countsLargeAllocations()) GTEST_SKIP() << "the sanitizer has an allocator of its own";
  WireFrame huge = makeFrame(1);
  huge.header.mutable_sources(0)->mutable_layers(0)->mutable_planes(1)->set_bytes_count(
      ~uint64_t{0});
  std::string bytes = head();
  for (const std::string& message : messagesOf(huge)) bytes += record(0, message);
  bytes += number(0, 8) + number(4 << 20, 4);  // of which nothing comes
  const fs::path file = folder_.write("huge.vlr", bytes);
  const uint64_t before = test::largeAllocationCount();
  bool is_cut_short = false;
  EXPECT_TRUE(readAll(file, &is_cut_short).empty());
  EXPECT_TRUE(is_cut_short);
  EXPECT_EQ(test::largeAllocationCount(), before);
}

}  // namespace
}  // namespace viewloom::frame_recording_test
