// SPDX-License-Identifier: Apache-2.0
#include "lib/atlas_assembler.h"

#include <gtest/gtest.h>

#include <functional>
#include <initializer_list>

namespace viewloom::atlas_assembler_test {
namespace {

using Message = v1::StreamAtlasesResponse;

Message layoutMessage() {
  Message message;
  message.mutable_layout()->mutable_size()->set_width(4);
  message.mutable_layout()->mutable_size()->set_height(4);
  return message;
}

Message headerMessage(uint64_t sequence, uint32_t band_count) {
  Message message;
  message.mutable_header()->set_sequence(sequence);
  message.mutable_header()->set_band_count(band_count);
  return message;
}

Message bandMessage(uint64_t sequence, uint32_t row, const std::string& data,
                    uint32_t offset_bytes = 0, bool last_piece = true) {
  Message message;
  v1::Band& band = *message.mutable_band();
  band.set_sequence(sequence);
  band.set_plane(v1::ATLAS_PLANE_COLOR);
  band.set_first_row(row);
  band.set_row_count(2);
  band.set_offset_bytes(offset_bytes);
  band.set_last_piece(last_piece);
  band.set_data(data);
  return message;
}

Message endMessage(uint64_t sequence) {
  Message message;
  message.mutable_end()->set_sequence(sequence);
  return message;
}

Message skippedMessage(uint64_t count) {
  Message message;
  message.mutable_skipped()->set_count(count);
  return message;
}

class AtlasAssemblerTest : public ::testing::Test {
 protected:
  // Adds messages that must be in order; returns the atlas that the last one ended.
  std::optional<Atlas> add(std::initializer_list<Message> messages) {
    std::optional<Atlas> atlas;
    for (const Message& message : messages) {
      auto added = assembler_.add(message);
      EXPECT_TRUE(added.ok()) << added.status();
      atlas = added.ok() ? *std::move(added) : std::nullopt;
    }
    return atlas;
  }

  absl::StatusCode codeOf(const Message& message) {
    return assembler_.add(message).status().code();
  }

  AtlasAssembler assembler_{/*bytes_max=*/100};
};

TEST_F(AtlasAssemblerTest, joinsBandsAndTheirPieces) {
  const auto atlas = add({layoutMessage(), headerMessage(1, 2), bandMessage(1, 0, "ab", 0, false),
                          bandMessage(1, 0, "cd", 2, true), bandMessage(1, 2, "e"), endMessage(1)});
  ASSERT_TRUE(atlas.has_value());
  EXPECT_EQ(atlas->header.sequence(), 1U);
  EXPECT_EQ(atlas->layout->size().height(), 4U);
  ASSERT_EQ(atlas->bands.size(), 2U);
  EXPECT_EQ(atlas->bands[0].bytes, "abcd");
  EXPECT_EQ(atlas->bands[1].first_row, 2U);
  EXPECT_EQ(atlas->byteCount(), 5U);
  EXPECT_EQ(assembler_.counts().whole, 1U);
}

TEST_F(AtlasAssemblerTest, discardsAnAtlasWithoutItsEnd) {
  const auto atlas = add({layoutMessage(), headerMessage(1, 2), bandMessage(1, 0, "x"),
                          headerMessage(2, 1), bandMessage(2, 0, "y"), endMessage(2)});
  ASSERT_TRUE(atlas.has_value());
  EXPECT_EQ(atlas->header.sequence(), 2U);
  EXPECT_EQ(atlas->bands[0].bytes, "y");
  EXPECT_EQ(assembler_.counts().discarded, 1U);
}

TEST_F(AtlasAssemblerTest, discardsWhatIsHalfDoneWhenTheLayoutChangesOrTheCallIsNew) {
  add({layoutMessage(), headerMessage(1, 1), bandMessage(1, 0, "x"), layoutMessage()});
  EXPECT_EQ(codeOf(endMessage(1)), absl::StatusCode::kDataLoss);
  add({headerMessage(7, 1)});
  assembler_.restart();
  EXPECT_EQ(codeOf(bandMessage(7, 0, "x")), absl::StatusCode::kDataLoss);
  EXPECT_EQ(assembler_.counts().discarded, 2U);
  EXPECT_EQ(assembler_.counts().whole, 0U);
}

TEST_F(AtlasAssemblerTest, discardsWhatTheServerAbandons) {
  Message abandoned;
  abandoned.mutable_abandoned()->set_sequence(1);
  EXPECT_FALSE(add({layoutMessage(), headerMessage(1, 1), bandMessage(1, 0, "x"), abandoned}));
  EXPECT_EQ(codeOf(endMessage(1)), absl::StatusCode::kDataLoss) << "whole it was never";
  const auto atlas = add({headerMessage(2, 1), bandMessage(2, 0, "y"), endMessage(2)});
  ASSERT_TRUE(atlas.has_value());
  EXPECT_EQ(atlas->bands.at(0).bytes, "y");
  EXPECT_EQ(assembler_.counts().discarded, 1U);
  EXPECT_EQ(assembler_.counts().whole, 1U);
}

TEST_F(AtlasAssemblerTest, takesTheOutcomeFromTheEnd) {
  Message end = endMessage(1);
  end.mutable_end()->mutable_times()->set_trace_ns(5);
  end.mutable_end()->mutable_coverage()->set_hit(0.5);
  const auto atlas = add({layoutMessage(), headerMessage(1, 0), end});
  EXPECT_EQ(atlas->end.times().trace_ns(), 5);
  EXPECT_EQ(atlas->end.coverage().hit(), 0.5);
}

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
TEST_F(AtlasAssemblerTest, takesTheOutcomeOfOlderServersFromTheHeader) {
  Message header = headerMessage(1, 0);
  header.mutable_header()->mutable_times()->set_trace_ns(5);
  header.mutable_header()->mutable_coverage()->set_hit(0.5);
  header.mutable_header()->mutable_reflections()->set_hit(1);
  const auto atlas = add({layoutMessage(), header, endMessage(1)});
  EXPECT_EQ(atlas->end.times().trace_ns(), 5);
  EXPECT_EQ(atlas->end.coverage().hit(), 0.5);
  EXPECT_EQ(atlas->end.reflections().hit(), 1);
  EXPECT_FALSE(atlas->header.has_times()) << "it stands in one place";
}
#pragma GCC diagnostic pop

TEST_F(AtlasAssemblerTest, countsGapsFromTheFirstAtlasOn) {
  add({layoutMessage(), headerMessage(40, 0), endMessage(40)});
  EXPECT_EQ(assembler_.counts().gaps, 0U) << "others watched before";
  add({headerMessage(41, 0), endMessage(41), skippedMessage(3), headerMessage(45, 0),
       endMessage(45)});
  EXPECT_EQ(assembler_.counts().gaps, 3U);
  EXPECT_EQ(assembler_.counts().skipped, 3U);
  assembler_.restart();
  add({layoutMessage(), headerMessage(1, 0), endMessage(1)});
  EXPECT_EQ(assembler_.counts().gaps, 3U);
}

TEST_F(AtlasAssemblerTest, refusesMessagesOutOfOrder) {
  EXPECT_EQ(codeOf(headerMessage(1, 1)), absl::StatusCode::kDataLoss) << "no layout yet";
  add({layoutMessage()});
  EXPECT_EQ(codeOf(bandMessage(1, 0, "x")), absl::StatusCode::kDataLoss) << "no header yet";
  add({headerMessage(1, 2), bandMessage(1, 0, "x")});
  EXPECT_EQ(codeOf(endMessage(1)), absl::StatusCode::kDataLoss) << "a band is missing";
  EXPECT_EQ(codeOf(bandMessage(2, 2, "x")), absl::StatusCode::kDataLoss) << "another atlas's band";
  EXPECT_EQ(codeOf(bandMessage(1, 2, "x", 5)), absl::StatusCode::kDataLoss) << "a piece is missing";
}

TEST_F(AtlasAssemblerTest, refusesLayoutsOfWhichNoViewCanBeCut) {
  const auto codeWith = [this](const std::function<void(v1::AtlasLayout&)>& spoil) {
    Message message = layoutMessage();
    v1::AtlasLayout& layout = *message.mutable_layout();
    layout.mutable_tile_size()->set_width(2);
    layout.mutable_tile_size()->set_height(4);
    layout.set_columns(2);
    layout.set_rows(1);
    layout.set_view_count(2);
    spoil(layout);
    return codeOf(message);
  };
  EXPECT_EQ(codeWith([](auto&) {}), absl::StatusCode::kOk);
  for (const auto& spoil : std::initializer_list<std::function<void(v1::AtlasLayout&)>>{
           [](auto& l) { l.mutable_size()->set_width(0); },
           [](auto& l) { l.mutable_size()->set_height(4'000'000'000); },
           [](auto& l) { l.mutable_tile_size()->set_width(3); },
           [](auto& l) { l.set_padding_top_px(1); }, [](auto& l) { l.set_columns(0); },
           [](auto& l) { l.set_image_count(5); }, [](auto& l) { l.set_image_count(3); }}) {
    EXPECT_EQ(codeWith(spoil), absl::StatusCode::kDataLoss);
  }
}

TEST_F(AtlasAssemblerTest, refusesAPieceOfAnotherBandInside) {
  add({layoutMessage(), headerMessage(1, 2), bandMessage(1, 0, "ab", 0, false)});
  EXPECT_EQ(codeOf(bandMessage(1, 2, "cd", 2, true)), absl::StatusCode::kDataLoss);
}

TEST_F(AtlasAssemblerTest, refusesBandsThatHoldNothing) {
  Message rowless = bandMessage(1, 0, "x");
  rowless.mutable_band()->set_row_count(0);
  add({layoutMessage(), headerMessage(1, 2)});
  EXPECT_EQ(codeOf(rowless), absl::StatusCode::kDataLoss);
  EXPECT_EQ(codeOf(bandMessage(1, 0, "")), absl::StatusCode::kDataLoss);
  add({headerMessage(2, 1), bandMessage(2, 0, "x")});
  EXPECT_EQ(codeOf(bandMessage(2, 2, "x")), absl::StatusCode::kDataLoss) << "not in the header";
}

TEST_F(AtlasAssemblerTest, boundsTheMemoryOfAnAtlas) {
  add({layoutMessage(), headerMessage(1, 2), bandMessage(1, 0, std::string(100, 'x'))});
  EXPECT_EQ(codeOf(bandMessage(1, 2, "x")), absl::StatusCode::kResourceExhausted);
}

}  // namespace
}  // namespace viewloom::atlas_assembler_test
