// SPDX-License-Identifier: Apache-2.0
// Moves of a call to other places, for which its client has not asked.
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "access/access_control.h"
#include "base/clock.h"
#include "fuzz/scripted_stream.h"
#include "messages/wire_message.h"
#include "rpc/watch_call.h"
#include "unit/publish/paced_readers.h"
#include "unit/web/no_eyes.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom::test::watch_places_test {
namespace {

using testing::EndsWith;

constexpr const char* kScene = "scene";
constexpr int64_t kMs = 1'000'000;
constexpr uint64_t kNeverMade = 1'000'000;

v1::StreamAtlasesRequest openVideo(v1::Prediction prediction) {
  v1::StreamAtlasesRequest request;
  v1::OpenDisplay& open = *request.mutable_open();
  open.set_stream(kScene);
  open.set_wait_for_stream(true);
  v1::QuiltDisplay& quilt = *open.mutable_display()->mutable_quilt();
  quilt.set_columns(2);
  quilt.set_rows(1);
  quilt.mutable_size()->set_width(64);
  quilt.mutable_size()->set_height(48);
  open.mutable_encoding()->set_color(v1::BAND_ENCODING_H264);
  open.mutable_encoding()->set_prediction(prediction);
  return request;
}

class WatchPlacesTest : public testing::Test {
 protected:
  WatchPlacesTest() {
    broadcaster_.onDemandChange([this](const std::string&) { on_demand_(); });
    call_->open();
  }
  ~WatchPlacesTest() override {
    stream_.cancel();
    stream_.halfClose();
    for (stream_.settle(); !stream_.hasEnded(); stream_.settle()) stream_.finishWrite(false);
  }

  void open(v1::Prediction prediction) {
    stream_.give(bytesFromMessage(openVideo(prediction)));
    ASSERT_EQ(displays().size(), 1u);
    first_id_ = displays().front()->id;
  }
  std::vector<ActiveDisplayPtr> displays() const { return broadcaster_.displays(kScene); }
  uint32_t viewerCount(uint64_t display_id) const {
    return broadcaster_.display(display_id)->subscriber_count;
  }

  // Somebody else at the display of the call.
  SubscriptionPtr joinBeside() {
    const ActiveDisplayPtr display = broadcaster_.display(first_id_);
    return join(broadcaster_, kScene, display->spec, std::make_shared<Watcher>(),
                display->encoding);
  }
  // The last display that there is room for.
  SubscriptionPtr openAnother() {
    return join(broadcaster_, "other", quiltOf(2), std::make_shared<Watcher>());
  }

  // The next atlas of a display. `reference`: 0 = it needs no other.
  void publish(uint64_t display_id, uint64_t reference = 0) {
    EncodedAtlas atlas;
    atlas.display_id = display_id;
    atlas.sequence = broadcaster_.nextSequence(display_id);
    atlas.reference_sequence = reference;
    atlas.layout = layout_;
    atlas.encoding = broadcaster_.display(display_id)->encoding;
    atlas.bands.push_back({.row_count = 48,
                           .encoding = BandEncoding::kH264,
                           .bytes = std::make_shared<std::vector<uint8_t>>(size_t{10})});
    broadcaster_.publish(std::make_shared<EncodedAtlas>(std::move(atlas)));
  }
  // The first atlas of each display that has none.
  void serveNewDisplays() {
    for (const ActiveDisplayPtr& display : displays()) {
      if (broadcaster_.newest(display->id) == nullptr) publish(display->id);
    }
  }

  void fallOut(size_t count) {
    for (size_t i = 0; i < count; ++i) {
      publish(first_id_);
      publish(first_id_, kNeverMade);
    }
  }

  // A display with a second rung, whose second atlas the client does not take.
  void openSlowly() {
    open(v1::PREDICTION_WITHIN_ATLAS);
    EXPECT_EQ(told(), "L1h1");
    publish(first_id_);
  }
  // Ten atlases a second of each display, of which the client of the call takes none.
  void runBesideAFastReader(int64_t duration_ms) {
    PacedReader fast{.place = joinBeside()};
    for (const int64_t end_ns = clock_.nowNs() + duration_ms * kMs; clock_.nowNs() < end_ns;) {
      auto bytes = codeAtlases(broadcaster_, kScene, clock_.nowNs(), 30 * kMs);
      fast.offer(bytes[first_id_], clock_.nowNs());
      clock_.advance(kAtlasesApart_ns);
      used_ns_ += kAtlasesApart_ns / 2;
      broadcaster_.remakeStanding(clock_.nowNs());
      call_->tick();
    }
  }

  // Layouts and headers that the client reads by now: "L2" is a layout of the second rung, "L1c"
  // one of chained video, "h3" the header of atlas 3.
  std::string told() {
    std::string text;
    for (auto bytes = stream_.written(); bytes; bytes = stream_.written()) {
      v1::StreamAtlasesResponse message;
      EXPECT_TRUE(parseMessage(*bytes, message).ok());
      stream_.finishWrite(true);
      if (message.has_layout()) text += layoutText(message.layout());
      if (message.has_header()) text += "h" + std::to_string(message.header().sequence());
    }
    return text;
  }
  static std::string layoutText(const v1::AtlasLayout& layout) {
    const bool is_chained = layout.encoding().prediction() == v1::PREDICTION_ACROSS_ATLASES;
    return "L" + std::to_string(layout.video_rung()) + (is_chained ? "c" : "");
  }

  ManualClock clock_;
  int64_t used_ns_ = 0;
  CodingRoom room_{2, [this] { return used_ns_; }};
  int refused_count_ = 0;
  MemoryBudget memory_{uint64_t{1} << 30, [this](MemoryUse) { ++refused_count_; }};
  Broadcaster broadcaster_{{.display_count_max = 2}, memory_, room_};
  std::function<void()> on_demand_ = [this] { serveNewDisplays(); };
  AccessControl access_{clock_};
  StreamDirectory directory_{clock_, 2};
  Metrics metrics_;
  NoEyes eyes_;
  const std::shared_ptr<const AtlasLayout> layout_ = std::make_shared<AtlasLayout>();
  uint64_t first_id_ = 0;
  std::shared_ptr<WatchCall> call_ =
      std::make_shared<WatchCall>(DisplayParts{.directory = directory_,
                                               .broadcaster = broadcaster_,
                                               .eyes = eyes_,
                                               .clock = clock_,
                                               .metrics = metrics_,
                                               .limits = {}},
                                  *access_.admit(kStreamAtlases, "127.0.0.1", ""), "127.0.0.1");
  ScriptedStream stream_{call_};
};

TEST_F(WatchPlacesTest, leavesAChainThatItFallsOutOf) {
  open(v1::PREDICTION_ACROSS_ATLASES);
  const auto beside = joinBeside();
  fallOut(FallOuts::kTooMany - 1);
  call_->tick();
  EXPECT_EQ(displays().size(), 1u);
  EXPECT_THAT(told(), EndsWith("L1ch6"));
  fallOut(1);
  EXPECT_EQ(told(), "h8");
  call_->tick();
  EXPECT_EQ(viewerCount(first_id_), 1u);
  EXPECT_EQ(told(), "L1h1") << "which came before the call had its place";
}

TEST_F(WatchPlacesTest, staysInItsChainWhereALimitRefusesTheOtherDisplay) {
  open(v1::PREDICTION_ACROSS_ATLASES);
  const auto beside = joinBeside();
  const auto other = openAnother();
  fallOut(FallOuts::kTooMany);
  told();
  call_->tick();
  EXPECT_FALSE(stream_.finished().has_value());
  EXPECT_EQ(viewerCount(first_id_), 2u);
  publish(first_id_);
  EXPECT_EQ(told(), "h10");
}

TEST_F(WatchPlacesTest, needsNoRoomForBothDisplaysToLeaveItsChain) {
  open(v1::PREDICTION_ACROSS_ATLASES);
  const auto other = openAnother();
  fallOut(FallOuts::kTooMany);
  call_->tick();
  EXPECT_THAT(told(), EndsWith("L1h1"));
  EXPECT_EQ(displays().size(), 1u);
}

TEST_F(WatchPlacesTest, asksForAnotherDisplayOnceForSoManyFallOuts) {
  open(v1::PREDICTION_ACROSS_ATLASES);
  const Reservation rest = memory_.charge(MemoryUse::kFrames, memory_.leftFor(""));
  fallOut(FallOuts::kTooMany);
  call_->tick();
  EXPECT_EQ(refused_count_, 1);
  fallOut(FallOuts::kTooMany - 1);
  call_->tick();
  EXPECT_EQ(refused_count_, 1);
  fallOut(1);
  call_->tick();
  EXPECT_EQ(refused_count_, 2);
  EXPECT_FALSE(stream_.finished().has_value());
}

TEST_F(WatchPlacesTest, getsWhatCameToTheSecondRungBeforeItHadMoved) {
  openSlowly();
  runBesideAFastReader(5000);
  EXPECT_EQ(metrics_.rung_moves[VideoRung::kSecond].value(), 1);
  EXPECT_THAT(told(), EndsWith("L2h1"));
  const auto second = displays();
  ASSERT_EQ(second.size(), 1u) << "the fast reader has left";
  publish(second.front()->id);
  EXPECT_EQ(told(), "h2");
}

TEST_F(WatchPlacesTest, comesBackWhereTheSecondRungEndedBeforeItHadMoved) {
  openSlowly();
  const auto beside = joinBeside();
  on_demand_ = [this] {
    for (const ActiveDisplayPtr& display : displays()) {
      const bool is_second = display->encoding.rung == VideoRung::kSecond;
      if (is_second) broadcaster_.refuse(display->id, absl::ResourceExhaustedError("planted"));
    }
  };
  runBesideAFastReader(5000);
  EXPECT_EQ(metrics_.rung_moves[VideoRung::kSecond].value(), 1);
  EXPECT_FALSE(stream_.finished().has_value());
  EXPECT_EQ(viewerCount(first_id_), 2u);
  EXPECT_THAT(told(), EndsWith("L1h2"));
}

TEST_F(WatchPlacesTest, comesBackWhereTheSecondRungEnds) {
  openSlowly();
  const auto beside = joinBeside();
  runBesideAFastReader(5000);
  ASSERT_EQ(displays().size(), 2u);
  broadcaster_.refuse(displays().back()->id, absl::ResourceExhaustedError("planted"));
  call_->tick();
  EXPECT_FALSE(stream_.finished().has_value());
  EXPECT_EQ(viewerCount(first_id_), 2u);
  EXPECT_THAT(told(), EndsWith("L1h2"));
}

TEST_F(WatchPlacesTest, staysWhereALimitRefusesTheSecondRung) {
  openSlowly();
  const auto beside = joinBeside();
  const auto other = openAnother();
  runBesideAFastReader(5000);
  EXPECT_EQ(metrics_.rung_moves[VideoRung::kSecond].value(), 0);
  EXPECT_EQ(viewerCount(first_id_), 2u);
  publish(first_id_);
  EXPECT_EQ(told(), "h2h3");
}

}  // namespace
}  // namespace viewloom::test::watch_places_test
