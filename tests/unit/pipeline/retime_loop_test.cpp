// SPDX-License-Identifier: Apache-2.0
#include "pipeline/retime_loop.h"

#include <gmock/gmock.h>

#include <array>
#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <semaphore>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace viewloom::retime_loop_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

ResidentPtr someStructure(const std::string& stream) {
  auto structure = std::make_shared<ResidentStructure>();
  structure->stream = stream;
  return structure;
}

AtlasJob tickOf(const std::string& picture_key, const ResidentPtr& structure, int64_t carried_ns) {
  AtlasJob job{.picture_key = picture_key, .structure = structure};
  job.tick = OutputTick{.shown = {.carried_ns = carried_ns}};
  return job;
}

// Records served jobs in order. The first job of the picture "held" waits until it is released.
class RetimeLoopTest : public testing::Test {
 protected:
  bool offer(const AtlasJob& job) { return loop_.offer(job, display_); }
  // Returns once the loop serves the job.
  void offerHeld(const std::string& stream, int64_t carried_ns = 1) {
    ASSERT_TRUE(offer(tickOf("held", someStructure(stream), carried_ns)));
    is_held_.acquire();
  }
  void waitUntilServed(const AtlasJob& job) {
    while (loop_.isBusy(job)) std::this_thread::yield();
  }
  FrameTicketPtr ticket(uint64_t frame_number) {
    return std::make_shared<FrameTicket>(frame_number, [this](const FrameReport& report) {
      std::lock_guard lock(mutex_);
      reported_.push_back(report.number);
    });
  }
  std::vector<std::string> served() {
    std::lock_guard lock(mutex_);
    return served_;
  }
  std::vector<uint64_t> reported() {
    std::lock_guard lock(mutex_);
    return reported_;
  }

  const ActiveDisplayPtr display_ = std::make_shared<ActiveDisplay>();
  Metrics metrics_;
  std::binary_semaphore is_held_{0};
  std::binary_semaphore may_go_on_{0};
  std::mutex mutex_;
  std::vector<std::string> served_;
  std::vector<uint64_t> reported_;
  RetimeLoop loop_{
      metrics_, [this](const AtlasJob& job, const DisplaySpec&, const std::stop_token& stop) {
        if (job.picture_key == "endless") {
          is_held_.release();
          while (!stop.stop_requested()) std::this_thread::yield();
        }
        if (job.picture_key == "held") {
          is_held_.release();
          may_go_on_.acquire();
        }
        if (job.picture_key == "broken") throw std::runtime_error("planted");
        std::lock_guard lock(mutex_);
        served_.push_back(job.picture_key + " " + std::to_string(job.tick->shown.carried_ns));
      }};
};

TEST_F(RetimeLoopTest, servesAStreamWhileAnotherIsBeingServed) {
  offerHeld("slow");
  const AtlasJob other = tickOf("other", someStructure("quick"), 1);
  EXPECT_TRUE(offer(other));
  waitUntilServed(other);
  EXPECT_THAT(served(), ElementsAre("other 1"));
  may_go_on_.release();
}

TEST_F(RetimeLoopTest, servesPicturesOfAStreamOneAfterTheOther) {
  offerHeld("scene");
  const ResidentPtr structure = someStructure("scene");
  EXPECT_TRUE(offer(tickOf("first", structure, 2)));
  EXPECT_TRUE(offer(tickOf("second", structure, 2)));
  EXPECT_THAT(served(), IsEmpty());
  may_go_on_.release();
  waitUntilServed(tickOf("second", structure, 2));
  EXPECT_THAT(served(), ElementsAre("held 1", "first 2", "second 2"));
}

TEST_F(RetimeLoopTest, goesOnWithAStreamAfterAnException) {
  const ResidentPtr structure = someStructure("scene");
  EXPECT_TRUE(offer(tickOf("broken", structure, 1)));
  waitUntilServed(tickOf("broken", structure, 1));
  EXPECT_TRUE(offer(tickOf("next", structure, 2)));
  waitUntilServed(tickOf("next", structure, 2));
  EXPECT_THAT(served(), ElementsAre("next 2"));
}

TEST_F(RetimeLoopTest, keepsTheNewestTickOfAPictureInItsPlaceAndCountsTheOther) {
  offerHeld("scene");
  const ResidentPtr structure = someStructure("scene");
  EXPECT_TRUE(offer(tickOf("first", structure, 2)));
  EXPECT_TRUE(offer(tickOf("second", structure, 2)));
  EXPECT_TRUE(offer(tickOf("first", structure, 3)));
  EXPECT_EQ(metrics_.output_ticks_skipped.value(), 1);
  may_go_on_.release();
  waitUntilServed(tickOf("second", structure, 2));
  EXPECT_THAT(served(), ElementsAre("held 1", "first 3", "second 2"));
}

TEST_F(RetimeLoopTest, handsTheTicketOfAReplacedTickToTheNewerUnlessThatHasOne) {
  offerHeld("scene");
  const ResidentPtr structure = someStructure("scene");
  AtlasJob job = tickOf("first", structure, 2);
  job.ticket = ticket(1);
  offer(job);
  job.ticket = nullptr;
  offer(tickOf("first", structure, 3));
  EXPECT_THAT(reported(), IsEmpty()) << "a newer atlas of the frame is on its way";
  AtlasJob newer = tickOf("first", someStructure("scene"), 0);
  newer.ticket = ticket(2);
  offer(newer);
  EXPECT_THAT(reported(), ElementsAre(1)) << "nobody will see that";
  newer.ticket = nullptr;
  may_go_on_.release();
  waitUntilServed(newer);
  loop_.stop();
  EXPECT_THAT(reported(), ElementsAre(1, 2));
}

TEST_F(RetimeLoopTest, skipsATickOfAPictureThatIsBeingServed) {
  offerHeld("scene");
  const AtlasJob next = tickOf("held", someStructure("scene"), 2);
  EXPECT_TRUE(loop_.isBusy(next));
  EXPECT_FALSE(offer(next));
  EXPECT_EQ(metrics_.output_ticks_skipped.value(), 0) << "whose it is, counts it";
  may_go_on_.release();
  waitUntilServed(next);
  EXPECT_THAT(served(), ElementsAre("held 1"));
}

// Else displays of one stream would never share what is made.
TEST_F(RetimeLoopTest, keepsATickThatShowsWhatIsBeingMade) {
  const ResidentPtr structure = someStructure("scene");
  ASSERT_TRUE(offer(tickOf("held", structure, 1)));
  is_held_.acquire();
  EXPECT_TRUE(offer(tickOf("first", structure, 1)));
  EXPECT_FALSE(offer(tickOf("first", structure, 2)));
  may_go_on_.release();
  waitUntilServed(tickOf("first", structure, 1));
  EXPECT_THAT(served(), ElementsAre("held 1", "first 1"));
}

TEST_F(RetimeLoopTest, finishesWhatIsBeingServedWhenItStopsAndForgetsTheRest) {
  offerHeld("scene");
  AtlasJob waiting = tickOf("first", someStructure("scene"), 1);
  waiting.ticket = ticket(1);
  EXPECT_TRUE(offer(waiting));
  waiting.ticket = nullptr;
  auto stopped = std::async(std::launch::async, [this] { loop_.stop(); });
  // Every job has a new picture, so the loop refuses one only after it has stopped.
  const ResidentPtr late = someStructure("late");
  for (int n = 0; offer(tickOf("late " + std::to_string(n), late, 1)); ++n) {
    std::this_thread::yield();
  }
  may_go_on_.release();
  stopped.wait();
  EXPECT_THAT(served(), Contains("held 1"));
  EXPECT_THAT(served(), Not(Contains("first 1")));
  EXPECT_THAT(reported(), ElementsAre(1));
}

TEST_F(RetimeLoopTest, tellsAllThatAreBeingServedToGiveUpWhenItStops) {
  for (const char* stream : {"first", "second"}) {
    ASSERT_TRUE(offer(tickOf("endless", someStructure(stream), 1)));
    is_held_.acquire();
  }
  loop_.stop();
  EXPECT_THAT(served(), ElementsAre("endless 1", "endless 1"));
}

// Streams and pictures from many threads: of a stream one at a time, of a picture ever newer ones,
// and each tick is served, or counted, or refused.
TEST(RetimeLoop, servesManyStreamsFromManyThreads) {
  constexpr int kStreams = 3, kPictures = 2, kTicks = 400;
  Metrics metrics;
  std::array<std::atomic<int>, kStreams> at_once{};
  std::array<std::array<int64_t, kPictures>, kStreams> last{};
  std::atomic<int> served_count = 0, refused_count = 0;
  const ActiveDisplayPtr display = std::make_shared<ActiveDisplay>();
  {
    RetimeLoop loop(metrics, [&](const AtlasJob& job, const DisplaySpec&, const std::stop_token&) {
      const auto stream = size_t(job.structure->stream.front() - '0');
      const auto picture = size_t(job.picture_key.back() - '0');
      EXPECT_EQ(at_once[stream]++, 0);
      EXPECT_LT(last[stream][picture], job.tick->shown.carried_ns);
      last[stream][picture] = job.tick->shown.carried_ns;
      ++served_count;
      --at_once[stream];
    });
    std::vector<std::jthread> threads;
    for (int stream = 0; stream < kStreams; ++stream) {
      threads.emplace_back([&, stream] {
        const ResidentPtr structure = someStructure(std::to_string(stream));
        for (int tick = 1; tick <= kTicks; ++tick) {
          for (int picture = 0; picture < kPictures; ++picture) {
            const std::string key = std::to_string(stream) + "/" + std::to_string(picture);
            const AtlasJob job = tickOf(key, structure, tick);
            if (!loop.offer(job, display)) ++refused_count;
          }
        }
        for (int picture = 0; picture < kPictures; ++picture) {
          const std::string key = std::to_string(stream) + "/" + std::to_string(picture);
          while (loop.isBusy(tickOf(key, structure, 0))) std::this_thread::yield();
        }
      });
    }
  }
  EXPECT_EQ(served_count + refused_count + int(metrics.output_ticks_skipped.value()),
            kStreams * kPictures * kTicks);
}

}  // namespace
}  // namespace viewloom::retime_loop_test
