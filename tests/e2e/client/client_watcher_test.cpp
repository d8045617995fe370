// SPDX-License-Identifier: Apache-2.0
// The watcher against a server that serves, skips, errs and breaks off.
#include "lib/watcher.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <future>
#include <mutex>
#include <thread>
#include <vector>

#include "e2e/client/scripted_server.h"
#include "lib/catalog.h"
#include "lib/channel.h"

namespace viewloom::client_watcher_test {
namespace {

using ::testing::ElementsAre;

constexpr int64_t kLong_ns = 60'000'000'000;  // only a failing test waits so long
constexpr BackoffOptions kQuick{.first_ns = 1'000'000, .max_ns = 10'000'000, .factor = 2};

grpc::Status noPublishing(PublishStream&, int) {
  return {grpc::StatusCode::UNIMPLEMENTED, "not in this test"};
}

v1::OpenDisplay readOpen(WatchStream& stream) {
  v1::StreamAtlasesRequest request;
  EXPECT_TRUE(stream.Read(&request));
  EXPECT_TRUE(request.has_open());
  return request.open();
}

void writeLayout(WatchStream& stream) {
  v1::StreamAtlasesResponse message;
  message.mutable_layout()->mutable_size()->set_width(1);
  message.mutable_layout()->mutable_size()->set_height(2);
  stream.Write(message);
}

void writeHeader(WatchStream& stream, uint64_t sequence) {
  v1::StreamAtlasesResponse message;
  message.mutable_header()->set_sequence(sequence);
  message.mutable_header()->set_frame_number(10 * sequence);
  message.mutable_header()->set_band_count(1);
  stream.Write(message);
}

void writeAtlas(WatchStream& stream, uint64_t sequence) {
  writeHeader(stream, sequence);
  v1::StreamAtlasesResponse message;
  v1::Band& band = *message.mutable_band();
  band.set_sequence(sequence);
  band.set_plane(v1::ATLAS_PLANE_COLOR);
  band.set_row_count(2);
  band.set_encoding(v1::BAND_ENCODING_RAW);
  band.set_last_piece(true);
  band.set_data("rgbRGB");
  stream.Write(message);
  message.mutable_end()->set_sequence(sequence);
  stream.Write(message);
}

class ClientWatcher : public ::testing::Test {
 protected:
  std::unique_ptr<Watcher> watch(const ScriptedServer& server, uint32_t count) {
    v1::OpenDisplay open;
    open.set_stream("s");
    open.mutable_display()->mutable_quilt()->set_preset("first");
    open.set_count(count);
    const WatcherCallbacks callbacks{
        .on_layout = {},
        .on_atlas = [this](const Atlas& atlas) { frames_.push_back(atlas.header.frame_number()); },
        .on_connection = {}};
    return std::make_unique<Watcher>(makeChannel(server.address()), open, callbacks, kQuick);
  }

  std::vector<uint64_t> frames_;  // read after the watcher ended
};

TEST_F(ClientWatcher, deliversWholeAtlasesUntilTheCountIsReached) {
  ScriptedServer server(noPublishing, [](WatchStream& stream, int) {
    EXPECT_EQ(readOpen(stream).count(), 2U);
    writeLayout(stream);
    writeAtlas(stream, 1);
    writeAtlas(stream, 4);
    return grpc::Status::OK;
  });
  const auto watcher = watch(server, 2);
  ASSERT_TRUE(watcher->waitEnded(kLong_ns));
  EXPECT_EQ(*watcher->ended(), absl::OkStatus());
  EXPECT_THAT(frames_, ElementsAre(10, 40));
  EXPECT_EQ(watcher->counts().atlases.whole, 2U);
  EXPECT_EQ(watcher->counts().atlases.gaps, 2U);
}

TEST_F(ClientWatcher, comesBackForTheRestAndDiscardsWhatWasHalfSent) {
  std::vector<v1::OpenDisplay> opened;
  ScriptedServer server(noPublishing, [&](WatchStream& stream, int call) {
    opened.push_back(readOpen(stream));
    writeLayout(stream);
    if (call == 1) {
      writeAtlas(stream, 1);
      writeHeader(stream, 2);
      return grpc::Status(grpc::StatusCode::UNAVAILABLE, "drains");
    }
    writeAtlas(stream, 1);
    writeAtlas(stream, 2);
    return grpc::Status::OK;
  });
  const auto watcher = watch(server, 3);
  ASSERT_TRUE(watcher->waitEnded(kLong_ns));
  EXPECT_EQ(*watcher->ended(), absl::OkStatus());
  EXPECT_THAT(frames_, ElementsAre(10, 10, 20));
  EXPECT_EQ(watcher->counts().atlases.discarded, 1U);
  EXPECT_EQ(watcher->counts().reconnects, 1U);
  ASSERT_EQ(opened.size(), 2U);
  EXPECT_FALSE(opened[0].wait_for_stream());
  EXPECT_TRUE(opened[1].wait_for_stream()) << "the publisher may be slower to come back";
  EXPECT_EQ(opened[1].count(), 2U);
}

TEST_F(ClientWatcher, callsAgainWhenAServerWithHeartbeatsFallsSilent) {
  ScriptedServer server(noPublishing, [&](WatchStream& stream, int call) {
    readOpen(stream);
    writeLayout(stream);
    if (call == 1) {
      v1::StreamAtlasesResponse beat;
      beat.mutable_heartbeat();
      stream.Write(beat);
      v1::StreamAtlasesRequest request;
      while (stream.Read(&request)) {
      }
    }
    writeAtlas(stream, 1);
    return grpc::Status::OK;
  });
  const auto watcher = watch(server, 1);
  ASSERT_TRUE(watcher->waitEnded(kLong_ns));
  EXPECT_EQ(*watcher->ended(), absl::OkStatus());
  EXPECT_THAT(frames_, ElementsAre(10));
  EXPECT_EQ(watcher->counts().reconnects, 1U);
}

TEST_F(ClientWatcher, survivesARestartOfTheServer) {
  std::promise<void> is_watching;
  ScriptedServer server(noPublishing, [&](WatchStream& stream, int call) {
    readOpen(stream);
    writeLayout(stream);
    writeAtlas(stream, 1);
    if (call > 1) return grpc::Status::OK;
    is_watching.set_value();
    v1::StreamAtlasesRequest request;
    stream.Read(&request);  // until the server goes down
    return grpc::Status(grpc::StatusCode::UNAVAILABLE, "down");
  });
  const auto watcher = watch(server, 2);
  is_watching.get_future().wait();
  server.stop();
  server.start();
  ASSERT_TRUE(watcher->waitEnded(kLong_ns));
  EXPECT_EQ(*watcher->ended(), absl::OkStatus());
  EXPECT_THAT(frames_, ElementsAre(10, 10));
}

TEST_F(ClientWatcher, changesItsDisplayNowAndAfterABrokenCall) {
  std::vector<std::string> presets;
  std::promise<void> is_open;
  ScriptedServer server(noPublishing, [&](WatchStream& stream, int call) {
    presets.push_back(readOpen(stream).display().quilt().preset());
    writeLayout(stream);
    if (call == 2) {
      writeAtlas(stream, 1);
      return grpc::Status::OK;
    }
    is_open.set_value();
    v1::StreamAtlasesRequest request;
    EXPECT_TRUE(stream.Read(&request));
    EXPECT_TRUE(request.has_presented());
    EXPECT_EQ(request.presented().sequence(), 7U);
    EXPECT_TRUE(stream.Read(&request));
    presets.push_back(request.change().display().quilt().preset());
    return grpc::Status(grpc::StatusCode::UNAVAILABLE, "drains");
  });
  const auto watcher = watch(server, 1);
  is_open.get_future().wait();
  watcher->reportPresented(7, 1);
  v1::ChangeDisplay change;
  change.mutable_display()->mutable_quilt()->set_preset("second");
  watcher->change(change);
  ASSERT_TRUE(watcher->waitEnded(kLong_ns));
  EXPECT_THAT(presets, ElementsAre("first", "second", "second"));
}

TEST_F(ClientWatcher, tellsWhereTheEyesAreNowAndAfterABrokenCall) {
  std::array<std::promise<void>, 3> are_open;  // [call]
  std::vector<v1::StreamAtlasesRequest> requests;
  ScriptedServer server(noPublishing, [&](WatchStream& stream, int call) {
    readOpen(stream);
    writeLayout(stream);
    are_open.at(size_t(call - 1)).set_value();
    v1::StreamAtlasesRequest request;
    EXPECT_TRUE(stream.Read(&request));
    requests.push_back(request);
    if (call == 1) return grpc::Status(grpc::StatusCode::UNAVAILABLE, "drains");
    // A display that is not tracked has no eyes, also after the next call has broken.
    if (call == 2) {
      writeAtlas(stream, 1);
      EXPECT_TRUE(stream.Read(&request) && request.has_change());
      return grpc::Status(grpc::StatusCode::UNAVAILABLE, "drains");
    }
    writeAtlas(stream, 1);
    return grpc::Status::OK;
  });
  const auto watcher = watch(server, 2);
  are_open[0].get_future().wait();
  v1::EyePoses poses;
  poses.set_time_ns(5);
  watcher->sendEyePoses(poses);
  while (watcher->counts().atlases.whole < 1) std::this_thread::yield();
  watcher->change({});
  are_open[2].get_future().wait();
  watcher->reportPresented(9, 0);
  ASSERT_TRUE(watcher->waitEnded(kLong_ns));
  EXPECT_EQ(*watcher->ended(), absl::OkStatus());
  ASSERT_EQ(requests.size(), 3U);
  EXPECT_EQ(requests[0].eye_poses().time_ns(), 5);
  EXPECT_EQ(requests[1].eye_poses().time_ns(), 5);
  EXPECT_EQ(requests[2].presented().sequence(), 9U) << "no eyes before it";
}

TEST_F(ClientWatcher, endsWhenTheServerHasNoSuchStream) {
  ScriptedServer server(noPublishing, [](WatchStream& stream, int) {
    readOpen(stream);
    return grpc::Status(grpc::StatusCode::NOT_FOUND, "there are a, b");
  });
  const auto watcher = watch(server, 1);
  ASSERT_TRUE(watcher->waitEnded(kLong_ns));
  EXPECT_EQ(watcher->ended()->code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(watcher->ended()->message(), "there are a, b");
}

TEST_F(ClientWatcher, endsWhenTheServerBreaksTheOrderOfItsMessages) {
  ScriptedServer server(noPublishing, [](WatchStream& stream, int) {
    readOpen(stream);
    writeHeader(stream, 1);
    v1::StreamAtlasesRequest request;
    EXPECT_FALSE(stream.Read(&request)) << "the client breaks off";
    return grpc::Status::OK;
  });
  const auto watcher = watch(server, 1);
  ASSERT_TRUE(watcher->waitEnded(kLong_ns));
  EXPECT_EQ(watcher->ended()->code(), absl::StatusCode::kDataLoss);
}

TEST_F(ClientWatcher, stopsWhileTheServerIsSilent) {
  std::promise<void> is_open;
  ScriptedServer server(noPublishing, [&](WatchStream& stream, int) {
    readOpen(stream);
    is_open.set_value();
    v1::StreamAtlasesRequest request;
    EXPECT_FALSE(stream.Read(&request));
    return grpc::Status::OK;
  });
  const auto watcher = watch(server, 0);
  is_open.get_future().wait();
  watcher->stop();
  ASSERT_TRUE(watcher->waitEnded(kLong_ns));
  EXPECT_EQ(watcher->ended()->code(), absl::StatusCode::kCancelled);
}

TEST(ClientCatalog, saysWhenNobodyListens) {
  ScriptedServer server(noPublishing, [](WatchStream&, int) { return grpc::Status::OK; });
  const std::string address = server.address();
  EXPECT_EQ(Catalog(makeChannel(address)).listStreams().status().code(),
            absl::StatusCode::kUnimplemented)
      << "this server has no catalogue";
  server.stop();
  EXPECT_EQ(Catalog(makeChannel(address)).listStreams().status().code(),
            absl::StatusCode::kUnavailable);
}

}  // namespace
}  // namespace viewloom::client_watcher_test
