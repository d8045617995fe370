// SPDX-License-Identifier: Apache-2.0
// Publishers and displays of a whole server, over gRPC, on a validated device.
#include <gmock/gmock.h>

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "e2e/service_fixture.h"
#include "lib/watcher.h"
#include "viewloom/v1/catalog_service.grpc.pb.h"

namespace viewloom::test::service_stream_test {
namespace {

// The frames of which a display got an atlas. Thread-safety: all methods from any thread.
class FrameLog {
 public:
  void add(uint64_t frame_number) {
    std::lock_guard lock(mutex_);
    numbers_.push_back(frame_number);
    changed_.notify_all();
  }

  // Waits until that frame has come; false means that it gave up.
  bool waitFor(uint64_t frame_number) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kGiveUpAfter,
                             [&] { return !numbers_.empty() && numbers_.back() >= frame_number; });
  }

  std::vector<uint64_t> numbers() {
    std::lock_guard lock(mutex_);
    return numbers_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<uint64_t> numbers_;
};

// The names that all threads of this process have now.
std::set<std::string> threadNames() {
  std::set<std::string> names;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream comm(task.path() / "comm");
    std::string name;
    std::getline(comm, name);
    names.insert(name);
  }
  return names;
}

class ServiceStreamTest : public ServiceFixture {
 protected:
  std::unique_ptr<Watcher> watch(FrameLog& log, SizePx size_px) {
    return watch(log, openQuilt("scene", size_px));
  }
  std::unique_ptr<Watcher> watch(FrameLog& log, const v1::OpenDisplay& display) {
    return std::make_unique<Watcher>(
        makeChannel(service_->grpcAddress()), display,
        WatcherCallbacks{.on_layout = {},
                         .on_atlas =
                             [&log](const Atlas& atlas) {
                               EXPECT_TRUE(hasWholePlane(atlas, v1::ATLAS_PLANE_COLOR));
                               log.add(atlas.header.frame_number());
                             },
                         .on_connection = {}});
  }
};

TEST_F(ServiceStreamTest, fastDisplaysLoseNothingBesideOneThatNeverReads) {
  constexpr uint64_t kFrameCount = 12;
  const auto stub = v1::DisplayService::NewStub(makeChannel(service_->grpcAddress()));
  grpc::ClientContext never_reads;
  const auto stuck = stub->StreamAtlases(&never_reads);
  v1::StreamAtlasesRequest request;
  *request.mutable_open() = openQuilt("scene", {600, 400});
  request.mutable_open()->mutable_encoding()->set_color(v1::BAND_ENCODING_RAW);
  ASSERT_TRUE(stuck->Write(request));

  FrameLog first_log;
  FrameLog second_log;
  const auto first = watch(first_log, {320, 200});
  const auto second = watch(second_log, {200, 320});
  FrameLog reported;
  Publisher publisher(
      makeChannel(service_->grpcAddress()), {.stream = "scene", .session_id = "", .backoff = {}},
      {.on_accepted = {},
       .on_report = [&](const v1::FrameReport& report) { reported.add(report.number()); },
       .on_wanted = {},
       .on_connection = {}});
  publisher.offer(syntheticWireFrame({160, 90}, 2, 0));
  ASSERT_TRUE(first_log.waitFor(1));
  ASSERT_TRUE(second_log.waitFor(1));
  for (uint64_t number = 2; number <= kFrameCount; ++number) {
    ASSERT_TRUE(reported.waitFor(number - 1));
    publisher.offer(syntheticWireFrame({160, 90}, 2, 0.1 * static_cast<double>(number)));
    ASSERT_TRUE(first_log.waitFor(number));
    ASSERT_TRUE(second_log.waitFor(number));
  }
  std::vector<uint64_t> every_frame(kFrameCount);
  for (uint64_t i = 0; i < kFrameCount; ++i) every_frame[i] = i + 1;
  for (const auto* watcher : {&first, &second}) {
    EXPECT_EQ((*watcher)->counts().atlases.skipped, 0u);
    EXPECT_EQ((*watcher)->counts().atlases.gaps, 0u);
    EXPECT_EQ((*watcher)->counts().atlases.discarded, 0u);
  }
  EXPECT_EQ(first_log.numbers(), every_frame);
  EXPECT_EQ(second_log.numbers(), every_frame);
  never_reads.TryCancel();
}

TEST_F(ServiceStreamTest, servesAJoinerFromTheLastFrameOfAPublisherThatHasLeft) {
  publishOnce(1);
  FrameLog log;
  const auto joiner = watch(log, {320, 200});
  EXPECT_TRUE(log.waitFor(1));
  EXPECT_EQ(service_->metrics().structures_built.value(), 1);
}

TEST_F(ServiceStreamTest, countsAFrameThatANewerOneReplacedOnce) {
  FrameLog log;
  // Frames that come between two ticks replace each other.
  v1::OpenDisplay ticking = openQuilt("scene", {320, 200});
  ticking.mutable_display()->mutable_effects()->mutable_temporal()->set_output_rate_hz(2);
  const auto watcher = watch(log, ticking);
  const auto channel = makeChannel(service_->grpcAddress());
  Publisher publisher(
      channel, {.stream = "scene", .session_id = "", .in_flight_max = 32, .backoff = {}}, {});
  const auto give_up = std::chrono::steady_clock::now() + kGiveUpAfter;
  WireFrame frame = syntheticWireFrame({160, 90}, 1, 0);
  while (publisher.counts().replaced_there == 0 && std::chrono::steady_clock::now() < give_up) {
    frame.header.set_exposure_ev(frame.header.exposure_ev() + 1e-3);  // none is like another
    publisher.offer(frame);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ASSERT_GT(publisher.counts().replaced_there, 0u);
  ASSERT_TRUE(publisher.finish(std::chrono::nanoseconds(kGiveUpAfter).count()).ok());

  v1::ListStreamsResponse streams;
  grpc::ClientContext context;
  const auto catalog = v1::CatalogService::NewStub(channel);
  ASSERT_TRUE(catalog->ListStreams(&context, {}, &streams).ok());
  ASSERT_EQ(streams.streams_size(), 1);
  EXPECT_EQ(streams.streams(0).replaced_count(), publisher.counts().replaced_there);
}

TEST_F(ServiceStreamTest, namesItsThreadsAfterTheirStages) {
  // gRPC names its own. Threads name themselves once they run, which may be after the service says
  // that it serves.
  const auto all = testing::IsSupersetOf(
      {"rpc ticker", "http", "decode", "build", "walk", "device", "ticks", "encode", "worker"});
  const auto give_up = std::chrono::steady_clock::now() + kGiveUpAfter;
  while (!testing::Matches(all)(threadNames()) && std::chrono::steady_clock::now() < give_up) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_THAT(threadNames(), all);
}

}  // namespace
}  // namespace viewloom::test::service_stream_test
