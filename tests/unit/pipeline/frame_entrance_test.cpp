// SPDX-License-Identifier: Apache-2.0
// Which frames are decoded and built, in a server of one thread by a clock that is turned by hand.
#include "pipeline/frame_entrance.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <memory>
#include <new>
#include <set>
#include <string>
#include <vector>

#include "base/str_cat.h"
#include "schedule/job_board.h"
#include "unit/pipeline/no_engine.h"

namespace viewloom::frame_entrance_test {
namespace {

constexpr int64_t kMs_ns = 1'000'000;
constexpr int64_t kDecode_ns = kMs_ns / 10;
constexpr int64_t kBuild_ns = 2 * kMs_ns;
constexpr int64_t kTrace_ns = 8 * kMs_ns;

class Viewer final : public Subscriber {
 public:
  void offer(AtlasPtr) override {}
  void end(const absl::Status&) override {}
};

FramePtr frameOf(uint64_t number) {
  auto frame = std::make_shared<Frame>();
  frame->format.number = number;
  return frame;
}

class FrameEntranceTest : public testing::Test {
 protected:
  // A publisher sends its next frame as soon as the one before is taken, however old it is by then.
  // Beside it, it may make no more than one in so long a time.
  struct Stream {
    int64_t interval_ns = 0;
    int64_t due_ns = 0;       // its next frame
    int64_t received_ns = 0;  // the one that waits
    bool waits = false;
    bool is_broken = false;  // frames do not decode
    uint64_t sent_count = 0;
  };

  FrameEntranceTest() {
    entrance_.onWanted([this](const std::string& stream) { asks_for_.insert(stream); });
  }

  Stream& watch(const std::string& name, uint32_t side_px = 64) {
    const DisplaySpec quilt = *completeDisplaySpec(
        {.kind = QuiltSpec{
             .columns = 2, .rows = 2, .size_px = {side_px, side_px}, .view_cone_rad = 0.5}});
    viewers_.push_back(*broadcaster_.subscribe(name, quilt, {}, std::make_shared<Viewer>()));
    return streams_by_name_[name];
  }

  void run(int64_t time_ns) {
    const int64_t end_ns = clock_.nowNs() + time_ns;
    while (clock_.nowNs() < end_ns) {
      send();
      intake();
      if (!build() && !trace() && asks_for_.empty()) clock_.advance(kDecode_ns);
    }
  }
  // Frames that were built and that nobody has seen, but for those that still may be seen.
  uint64_t unseenCount() const {
    uint64_t count = 0;
    for (const uint64_t serial : built_) {
      const bool is_newest = std::ranges::any_of(streams_by_name_, [&](const auto& entry) {
        const PipelineStreamPtr stream = streams_.find(entry.first);
        return stream && stream->resident() && stream->resident()->serial == serial;
      });
      count += !traced_.contains(serial) && !is_newest;
    }
    return count;
  }
  uint64_t pictureCount() const { return picture_count_; }
  uint64_t decodedCount() const { return decoded_count_; }
  uint64_t queuedCount() const { return queued_count_; }  // by the entrance
  uint64_t builtCount() const { return built_.size(); }
  int64_t oldestNs() const { return oldest_ns_; }
  uint64_t ringCount() const { return ring_count_; }  // of the builders
  bool knock(const std::string& name) { return entrance_.wantsFrame(name); }
  bool letIn(const std::string& name) { return entrance_.letIn(*streams_.open(name)); }
  void forget(const std::string& name) { entrance_.forget(name); }
  bool isAskedFor(const std::string& name) const { return asks_for_.contains(name); }

  ManualClock clock_;
  bool takes_all_ = false;     // a server that builds each frame when it comes
  bool lacks_memory_ = false;  // to know whether a frame is built unasked

 private:
  void send() {
    for (auto& [name, stream] : streams_by_name_) {
      if (stream.waits || clock_.nowNs() < stream.due_ns) continue;
      stream.waits = true;
      stream.received_ns = clock_.nowNs();
      stream.due_ns = clock_.nowNs() + stream.interval_ns;
      ++stream.sent_count;
      asks_for_.insert(name);
    }
  }

  void intake() {
    for (const std::string& name : std::exchange(asks_for_, {})) {
      Stream& stream = streams_by_name_.at(name);
      if (!stream.waits || !entrance_.wantsFrame(name)) continue;
      stream.waits = false;
      ++decoded_count_;
      clock_.advance(kDecode_ns);
      if (stream.is_broken) {
        entrance_.noteLost(name);
        continue;
      }
      const PipelineStreamPtr to = streams_.open(name);
      to->inbox.push({.frame = frameOf(stream.sent_count), .session = 1, .ticket = nullptr});
      received_ns_[serial_ + 1] = stream.received_ns;
      entrance_.noteOffered(to);
      build();
    }
  }

  bool build() {
    for (const PipelineStreamPtr& stream : streams_.all()) {
      if (!stream->hasFrame()) continue;
      const OfferedFrame offered = *stream->inbox.take();
      clock_.advance(kBuild_ns);
      auto structure = std::make_shared<ResidentStructure>();
      structure->stream = stream->name;
      structure->serial = ++serial_;
      structure->frame_number = offered.frame->format.number;
      stream->turn.noteBuilt({.is_watched = true}, clock_.nowNs());
      stream->setNewest({.structure = structure, .motion = {}});
      built_.push_back(serial_);
      for (AtlasJob& job :
           jobsOfFrame(structure, broadcaster_.displays(stream->name), nullptr, clock_.nowNs())) {
        board_.offer(std::move(job));
      }
      stream->door.close();
      entrance_.goOn(*stream);
      return true;
    }
    return false;
  }

  bool trace() {
    const std::optional<AtlasJob> job =
        board_.begin(0, nullptr, [](const Payers&) { return true; });
    if (!job) return false;
    uint64_t& shown = shown_[job->picture_key];
    if (job->structure->serial <= shown) {
      const bool comes = entrance_.askNewer(job->structure->stream, job->picture_key);
      if (!comes) board_.finish(job->picture_key);
      return true;
    }
    shown = job->structure->serial;
    traced_.insert(shown);
    ++picture_count_;
    oldest_ns_ = std::max(oldest_ns_, clock_.nowNs() - received_ns_[shown]);
    entrance_.noteBegun(*job);
    shares_.begin(claimOf(*job), kTrace_ns);
    for (int i = 0; i < 8; ++i) {  // frames come meanwhile
      clock_.advance(kTrace_ns / 8);
      send();
      intake();
    }
    board_.finish(job->picture_key);
    return true;
  }

  bool takesUnasked(const PipelineStream& stream) const {
    if (lacks_memory_) throw std::bad_alloc();
    const StreamDemand demand{.is_watched = true, .takes_all = takes_all_};
    return !stream.turn.waitUntilNs(demand, clock_.nowNs());
  }

  FairShares shares_;
  JobBoard board_{clock_, shares_, 1};
  const Engines engines_ = test::noEngines();
  Broadcaster broadcaster_{{}};
  StreamTable streams_{engines_, unboundedMemory(), 2, [] {}};
  FrameEntrance entrance_{
      streams_,
      broadcaster_,
      clock_,
      {.offer =
           [this](AtlasJob job) {
             board_.offer(std::move(job));
             ++queued_count_;
           },
       .finish = [this](const std::string& key) { board_.finish(key); },
       .on_finished = [] {},
       .ring_builds = [this] { ++ring_count_; },
       .takes_unasked = [this](const PipelineStream& stream) { return takesUnasked(stream); }}};
  std::map<std::string, Stream> streams_by_name_;
  std::vector<std::unique_ptr<Broadcaster::Subscription>> viewers_;
  std::set<std::string> asks_for_;  // streams whose waiting frame may be wanted
  uint64_t serial_ = 0;
  std::map<uint64_t, int64_t> received_ns_;  // by serial
  std::vector<uint64_t> built_;              // serials
  std::set<uint64_t> traced_;                // serials
  std::map<std::string, uint64_t> shown_;    // serial by picture
  uint64_t picture_count_ = 0;
  uint64_t decoded_count_ = 0;
  uint64_t queued_count_ = 0;
  uint64_t ring_count_ = 0;
  int64_t oldest_ns_ = 0;
};

TEST_F(FrameEntranceTest, buildsNoFrameThatNobodySeesOfPublishersThatSendTooMuch) {
  constexpr size_t kStreams = 12;
  for (size_t i = 0; i < kStreams; ++i) watch(strCat("stream", i));
  run(2000 * kMs_ns);
  EXPECT_EQ(unseenCount(), 0u);
  EXPECT_LE(decodedCount(), builtCount() + 1);
  EXPECT_LE(builtCount(), pictureCount() + kStreams);
  EXPECT_NEAR(double(pictureCount()), 2000.0 * kMs_ns / (kDecode_ns + kBuild_ns + kTrace_ns), 5);
}

// The counts above find a server that does not wait for the turns of pictures.
TEST_F(FrameEntranceTest, countsWhatIsBuiltForNobody) {
  takes_all_ = true;
  for (size_t i = 0; i < 12; ++i) watch(strCat("stream", i));
  run(2000 * kMs_ns);
  EXPECT_GT(unseenCount(), pictureCount() / 2);
}

TEST_F(FrameEntranceTest, showsEachFrameAtOnceWhileThereIsTime) {
  for (const char* name : {"one", "two"}) watch(name).interval_ns = 100 * kMs_ns;
  run(2000 * kMs_ns);
  EXPECT_NEAR(double(pictureCount()), 40, 2);
  EXPECT_EQ(unseenCount(), 0u);
  EXPECT_LE(oldestNs(), 2 * (kDecode_ns + kBuild_ns + kTrace_ns)) << "beside one other";
}

TEST_F(FrameEntranceTest, sharesTheTimeAmongStreams) {
  Stream& busy = watch("busy");
  Stream& calm = watch("calm");
  calm.interval_ns = 50 * kMs_ns;
  run(2000 * kMs_ns);
  EXPECT_NEAR(double(calm.sent_count), 40, 2) << "none of its frames waits for long";
  EXPECT_GT(busy.sent_count, 130u);
}

TEST_F(FrameEntranceTest, buildsAFrameOnceForAllPicturesThatAskForIt) {
  watch("stream", 64);
  watch("stream", 128);
  run(2000 * kMs_ns);
  EXPECT_EQ(unseenCount(), 0u);
  EXPECT_LE(builtCount(), pictureCount() * 6 / 10);
}

TEST_F(FrameEntranceTest, queuesPicturesOnceForEachTurn) {
  constexpr uint32_t kPictures = 32;
  for (uint32_t picture = 1; picture <= kPictures; ++picture) watch("stream", 16 * picture);
  run(2000 * kMs_ns);
  EXPECT_EQ(unseenCount(), 0u);
  EXPECT_GT(pictureCount(), 150u);
  EXPECT_LE(queuedCount(), 2 * (pictureCount() + kPictures));
}

TEST_F(FrameEntranceTest, hasBuildersLookWhereNoMemoryTellsWhetherAFrameComesIn) {
  lacks_memory_ = true;
  EXPECT_FALSE(knock("stream"));
  EXPECT_EQ(ringCount(), 1u);
  EXPECT_TRUE(letIn("stream"));
  EXPECT_TRUE(knock("stream"));
}

// A frame that came while its stream was being forgotten has knocked at a door that is gone.
TEST_F(FrameEntranceTest, asksForTheFrameOfAStreamThatIsForgotten) {
  lacks_memory_ = true;
  EXPECT_FALSE(knock("stream"));
  EXPECT_FALSE(isAskedFor("stream"));
  forget("stream");
  EXPECT_TRUE(isAskedFor("stream"));
  EXPECT_TRUE(!knock("stream") && letIn("stream"));
}

TEST_F(FrameEntranceTest, goesOnAfterFramesThatDoNotDecode) {
  Stream& stream = watch("stream");
  run(100 * kMs_ns);
  const uint64_t before = pictureCount();
  stream.is_broken = true;
  run(100 * kMs_ns);
  EXPECT_LE(pictureCount(), before + 1);
  stream.is_broken = false;
  run(100 * kMs_ns);
  EXPECT_GE(pictureCount(), before + 9);
}

}  // namespace
}  // namespace viewloom::frame_entrance_test
