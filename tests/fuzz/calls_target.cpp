// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "access/access_control.h"
#include "base/check.h"
#include "base/clock.h"
#include "e2e/answering_sink.h"
#include "fuzz/script.h"
#include "fuzz/scripted_stream.h"
#include "fuzz/shared_intake.h"
#include "fuzz/targets.h"
#include "lib/atlas_assembler.h"
#include "messages/wire_message.h"
#include "rpc/publish_call.h"
#include "rpc/watch_call.h"
#include "viewloom/v1/display_service.pb.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {
namespace {

constexpr size_t kCallCountMax = 6;
constexpr int kStepCountMax = 200;
constexpr int64_t kTickNs = 250'000'000;

enum class Step : uint8_t {
  kSend,  // the length in two bytes, and a message
  kWritten,
  kHalfClose,
  kCancel,
  kLoseWrite,
  kTick,
  kPublish,  // opens a call
  kWatch,
  kHold,  // from now on, frames wait to be decoded
  kLetGo,
  kCount
};

// Metrics take long to make.
const Metrics& metrics() {
  static const Metrics shared;
  return shared;
}

SharedIntake& sharedIntake() {
  static SharedIntake shared;
  return shared;
}

// The server's side of the calls, without an engine: the sink answers frames with known bytes.
class World {
 public:
  World() {
    sharedIntake().serve(&sink_);
    broadcaster_.onDemandChange([this](const std::string& stream) {
      sink_.demandChanged(stream);
      for (const auto& weak : publishers_) {
        if (const auto call = weak.lock()) call->refreshWanted();
      }
    });
  }
  ~World() {
    sharedIntake().serve(nullptr);
    broadcaster_.drain();
  }

  std::shared_ptr<PublishCall> publish() {
    auto call = std::make_shared<PublishCall>(
        IngestParts{.intake = sharedIntake().intake(),
                    .pool = sharedIntake().pool(),
                    .directory = directory_,
                    .broadcaster = broadcaster_,
                    .clock = clock_,
                    .metrics = metrics(),
                    .limits = {.plane_side_px_max = 64, .frame_bytes_max = 1 << 16}},
        *access_.admit(kPublishFrames, "127.0.0.1", ""), "127.0.0.1");
    publishers_.push_back(call);
    return call;
  }
  std::shared_ptr<WatchCall> watch() {
    return std::make_shared<WatchCall>(
        DisplayParts{.directory = directory_,
                     .broadcaster = broadcaster_,
                     .eyes = sink_,
                     .clock = clock_,
                     .metrics = metrics(),
                     .limits = {.side_px_max = 256, .area_px_max = 1 << 16, .view_count_max = 64}},
        *access_.admit(kStreamAtlases, "127.0.0.1", ""), "127.0.0.1");
  }

  void advance() { clock_.advance(kTickNs); }
  void hold() { sharedIntake().hold(); }
  void letGo() { sharedIntake().letGo(); }
  // A script always ends the same: reports, which come on other threads, are waited for.
  void settle() { sharedIntake().settle(static_cast<uint64_t>(metrics().frames_received.value())); }
  bool hasLiveStream() const {
    for (const StreamEntry& entry : directory_.list()) {
      if (entry.live) return true;
    }
    return false;
  }
  bool hasDisplay() const { return !broadcaster_.displays("").empty(); }

 private:
  ManualClock clock_;
  AccessControl access_{clock_};
  StreamDirectory directory_{clock_, 2};
  Broadcaster broadcaster_{{.display_count_max = 2, .subscriber_count_max = 3}};
  AnsweringSink sink_{directory_, broadcaster_};
  std::vector<std::weak_ptr<PublishCall>> publishers_;
};

// One client's end of a call.
class Client {
 public:
  using Call = std::variant<std::weak_ptr<PublishCall>, std::weak_ptr<WatchCall>>;

  template <typename SomeCall>
  explicit Client(const std::shared_ptr<SomeCall>& call)
      : call_(std::weak_ptr<SomeCall>(call)), stream_(call) {
    call->open();
  }

  void act(Step step, Script& script) {
    if (stream_.hasEnded()) return;
    switch (step) {
      case Step::kSend: {
        const size_t message_bytes = script.take(2);
        const FuzzBytes bytes = script.takeBytes(message_bytes);
        const grpc::Slice slice(bytes.data(), bytes.size());
        stream_.give({&slice, 1});
        break;
      }
      case Step::kWritten:
        takeWritten();
        stream_.finishWrite(true);
        break;
      case Step::kHalfClose:
        stream_.halfClose();
        break;
      case Step::kCancel:
        stream_.cancel();
        break;
      case Step::kLoseWrite:
        stream_.finishWrite(false);
        break;
      default:
        tick();
    }
    stream_.settle();
  }

  // The connection is gone.
  void breakOff() {
    stream_.cancel();
    stream_.halfClose();
    stream_.finishWrite(false);
    stream_.settle();
    VIEWLOOM_CHECK(stream_.hasEnded());
    VIEWLOOM_CHECK(std::visit([](const auto& call) { return call.expired(); }, call_));
  }

  bool gotSomething() const { return got_count_ > 0; }

 private:
  void tick() {
    std::visit(
        [](const auto& weak) {
          if (const auto call = weak.lock()) call->tick();
        },
        call_);
  }

  // Clients understand all that a server says.
  void takeWritten() {
    std::optional<grpc::ByteBuffer> bytes = stream_.written();
    if (!bytes) return;
    ++got_count_;
    if (std::holds_alternative<std::weak_ptr<PublishCall>>(call_)) {
      v1::PublishFramesResponse response;
      VIEWLOOM_CHECK(parseMessage(*bytes, response).ok());
      return;
    }
    v1::StreamAtlasesResponse response;
    VIEWLOOM_CHECK(parseMessage(*bytes, response).ok());
    VIEWLOOM_CHECK(assembler_.add(std::move(response)).ok());
  }

  const Call call_;
  ScriptedStream stream_;
  AtlasAssembler assembler_;
  size_t got_count_ = 0;
};

void openCall(Step step, World& world, std::vector<std::unique_ptr<Client>>& clients) {
  if (clients.size() == kCallCountMax) return;
  if (step == Step::kPublish) {
    clients.push_back(std::make_unique<Client>(world.publish()));
  } else {
    clients.push_back(std::make_unique<Client>(world.watch()));
  }
}

// One step of the script.
void act(Step step, Script& script, World& world, std::vector<std::unique_ptr<Client>>& clients) {
  switch (step) {
    case Step::kPublish:
    case Step::kWatch:
      return openCall(step, world, clients);
    case Step::kHold:
      return world.hold();
    case Step::kLetGo:
      return world.letGo();
    case Step::kTick:
      world.advance();
      break;
    default:
      break;
  }
  if (!clients.empty()) clients[script.take() % clients.size()]->act(step, script);
}

}  // namespace

bool fuzzCalls(FuzzBytes bytes) {
  Script script(bytes);
  World world;
  std::vector<std::unique_ptr<Client>> clients;
  for (int step = 0; step < kStepCountMax && !script.atEnd(); ++step) {
    act(static_cast<Step>(script.take() % static_cast<uint32_t>(Step::kCount)), script, world,
        clients);
    world.settle();
  }
  world.letGo();
  world.settle();
  bool is_answered = false;
  for (const auto& client : clients) {
    is_answered |= client->gotSomething();
    client->breakOff();
  }
  VIEWLOOM_CHECK(!world.hasLiveStream() && !world.hasDisplay());
  return is_answered;
}

}  // namespace viewloom
