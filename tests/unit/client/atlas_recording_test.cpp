// SPDX-License-Identifier: Apache-2.0
#include "recording/atlas_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "unit/client/test_files.h"

namespace viewloom::atlas_recording_test {
namespace {

using testing::HasSubstr;
using Message = v1::StreamAtlasesResponse;
namespace fs = std::filesystem;

Message layoutMessage() {
  Message message;
  v1::AtlasLayout& layout = *message.mutable_layout();
  layout.mutable_size()->set_width(8);
  layout.mutable_size()->set_height(4);
  layout.mutable_tile_size()->set_width(4);
  layout.mutable_tile_size()->set_height(4);
  layout.set_columns(2);
  layout.set_rows(1);
  layout.set_view_count(2);
  layout.set_suffix("_qs2x1a1");
  return message;
}

Message headerMessage(uint64_t sequence) {
  Message message;
  message.mutable_header()->set_sequence(sequence);
  message.mutable_header()->set_frame_number(100 + sequence);
  message.mutable_header()->set_band_count(1);
  return message;
}

Message bandMessage(uint64_t sequence) {
  Message message;
  message.mutable_band()->set_sequence(sequence);
  message.mutable_band()->set_row_count(4);
  message.mutable_band()->set_last_piece(true);
  message.mutable_band()->set_data("atlas " + std::to_string(sequence));
  return message;
}

Message abandonedMessage(uint64_t sequence) {
  Message message;
  message.mutable_abandoned()->set_sequence(sequence);
  return message;
}

Message endMessage(uint64_t sequence) {
  Message message;
  message.mutable_end()->set_sequence(sequence);
  return message;
}

class AtlasRecordingTest : public testing::Test {
 protected:
  // 10 ms between messages.
  fs::path recordMessages(const std::vector<Message>& messages) {
    const fs::path file = folder_.path() / "atlases.vlr";
    const auto recorder = AtlasRecorder::create(file, clock_);
    EXPECT_TRUE(recorder.ok()) << recorder.status();
    for (const Message& message : messages) {
      EXPECT_EQ((*recorder)->add(message), absl::OkStatus());
      clock_.advance(10'000'000);
    }
    EXPECT_EQ((*recorder)->complete(), absl::OkStatus());
    return file;
  }

  absl::StatusOr<std::vector<RecordedAtlas>> readAll(const fs::path& file) {
    std::vector<RecordedAtlas> atlases;
    const auto reader = AtlasRecordingReader::open(file);
    if (!reader.ok()) return reader.status();
    for (;;) {
      auto atlas = (*reader)->next();
      if (!atlas.ok()) return atlas.status();
      if (!atlas->has_value()) return atlases;
      atlases.push_back(**std::move(atlas));
    }
  }

  files::TestFolder folder_;
  ManualClock clock_;
};

TEST_F(AtlasRecordingTest, givesAtlasesBackWithTheTimesOfTheirEnds) {
  const auto atlases =
      readAll(recordMessages({layoutMessage(), headerMessage(1), bandMessage(1), endMessage(1),
                              headerMessage(2), bandMessage(2), endMessage(2), Message()}));
  ASSERT_TRUE(atlases.ok()) << atlases.status();
  ASSERT_EQ(atlases->size(), 2U);
  EXPECT_EQ((*atlases)[0].time_ns, 30'000'000);
  EXPECT_EQ((*atlases)[1].time_ns, 60'000'000);
  EXPECT_EQ((*atlases)[1].atlas.header.frame_number(), 102U);
  EXPECT_EQ((*atlases)[1].atlas.bands.at(0).bytes, "atlas 2");
  EXPECT_EQ((*atlases)[1].atlas.layout->suffix(), "_qs2x1a1");
}

TEST_F(AtlasRecordingTest, leavesOutWhatWasBrokenOff) {
  // A call that broke within atlas 1, one that goes on, an atlas that the server abandons, and the
  // end of the recording within 4.
  const auto atlases =
      readAll(recordMessages({layoutMessage(), headerMessage(1), bandMessage(1), layoutMessage(),
                              headerMessage(2), bandMessage(2), endMessage(2), headerMessage(3),
                              bandMessage(3), abandonedMessage(3), headerMessage(4)}));
  ASSERT_TRUE(atlases.ok()) << atlases.status();
  ASSERT_EQ(atlases->size(), 1U);
  EXPECT_EQ((*atlases)[0].atlas.header.sequence(), 2U);
}

TEST_F(AtlasRecordingTest, saysWhenAnAtlasIsOpen) {
  const auto recorder = AtlasRecorder::create(folder_.path() / "open.vlr", clock_);
  ASSERT_TRUE(recorder.ok());
  const std::pair<Message, bool> steps[] = {{layoutMessage(), false}, {headerMessage(1), true},
                                            {bandMessage(1), true},   {endMessage(1), false},
                                            {headerMessage(2), true}, {layoutMessage(), false},
                                            {headerMessage(3), true}, {abandonedMessage(3), false}};
  for (const auto& [message, is_open] : steps) {
    ASSERT_EQ((*recorder)->add(message), absl::OkStatus());
    EXPECT_EQ((*recorder)->isWithinAtlas(), is_open);
  }
  EXPECT_EQ((*recorder)->atlasCount(), 1U);
}

TEST_F(AtlasRecordingTest, isReadableWhereverItIsCut) {
  const fs::path whole =
      recordMessages({layoutMessage(), headerMessage(1), bandMessage(1), endMessage(1)});
  const size_t size = fs::file_size(whole);
  const size_t end_record_bytes = 12;
  for (size_t count = 16; count < size; ++count) {
    const auto reader = AtlasRecordingReader::open(folder_.truncated(whole, count));
    ASSERT_TRUE(reader.ok());
    const auto atlas = (*reader)->next();
    ASSERT_TRUE(atlas.ok()) << atlas.status();
    EXPECT_EQ(atlas->has_value(), count >= size - end_record_bytes) << count;
    if (atlas->has_value()) {
      EXPECT_FALSE((*reader)->next()->has_value());
    }
    EXPECT_TRUE((*reader)->isCutShort()) << count;
  }
}

TEST_F(AtlasRecordingTest, refusesLayoutsThatDoNotAddUp) {
  const std::pair<const char*, std::function<void(v1::AtlasLayout&)>> cases[] = {
      {"has an atlas of 0x4 px", [](auto& l) { l.mutable_size()->set_width(0); }},
      {"has an atlas of 8x4000000000 px",
       [](auto& l) { l.mutable_size()->set_height(4'000'000'000); }},
      {"without room for its views", [](auto& l) { l.mutable_tile_size()->set_width(5); }},
      {"without room for its views", [](auto& l) { l.set_rows(4'000'000'000); }},
      {"without room for its views", [](auto& l) { l.set_padding_top_px(1); }},
      {"without room for its views", [](auto& l) { l.set_view_count(3); }},
      {"without room for its views", [](auto& l) { l.set_columns(0); }},
      {"has a suffix that is no part of a file name", [](auto& l) { l.set_suffix("/../../x"); }}};
  for (const auto& [reason, spoil] : cases) {
    Message layout = layoutMessage();
    spoil(*layout.mutable_layout());
    const auto atlases =
        readAll(recordMessages({layout, headerMessage(1), bandMessage(1), endMessage(1)}));
    EXPECT_THAT(std::string(atlases.status().message()), HasSubstr(reason));
    EXPECT_THAT(std::string(atlases.status().message()), HasSubstr("at byte 16"));
  }
}

TEST_F(AtlasRecordingTest, refusesMessagesThatNoReaderTakes) {
  Message large = bandMessage(1);
  large.mutable_band()->set_data(std::string(4 << 20, 'x'));
  const auto recorder = AtlasRecorder::create(folder_.path() / "large.vlr", clock_);
  ASSERT_TRUE(recorder.ok()) << recorder.status();
  ASSERT_TRUE((*recorder)->add(layoutMessage()).ok());
  const absl::Status refused = (*recorder)->add(large);
  EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(refused.message()), HasSubstr("accepted are up to 4194304"));
}

TEST_F(AtlasRecordingTest, refusesMessagesOutOfOrder) {
  const auto of = [&](const std::vector<Message>& messages) {
    return std::string(readAll(recordMessages(messages)).status().message());
  };
  EXPECT_THAT(of({layoutMessage(), bandMessage(1), endMessage(1)}),
              HasSubstr("outside it at byte"));
  EXPECT_THAT(of({headerMessage(1), bandMessage(1), endMessage(1)}),
              HasSubstr("before any layout"));
  EXPECT_THAT(of({layoutMessage(), headerMessage(1), endMessage(1)}),
              HasSubstr("before it was whole"));
}

}  // namespace
}  // namespace viewloom::atlas_recording_test
