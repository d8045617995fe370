// SPDX-License-Identifier: Apache-2.0
#include "lib/retry_loop.h"

#include <gmock/gmock.h>
#include <grpcpp/support/status.h>
#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "lib/broken_call.h"
#include "lib/channel.h"

namespace viewloom::retry_loop_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr BackoffOptions kOptions{.first_ns = 100, .max_ns = 450, .factor = 2};

CallEnd unavailable(bool was_connected = false) {
  return {absl::UnavailableError("gone"), was_connected};
}

// A loop whose sleeps take no time and are recorded; jitter in the middle, so that delays are
// exact.
class RecordedLoop {
 public:
  absl::Status run(const std::function<CallEnd()>& call) {
    RetryLoop loop(
        kOptions, [this](const ConnectionEvent& event) { events.push_back(event); },
        [] { return 0.5; },
        [this](const std::stop_token&, int64_t delay_ns) { delays_ns.push_back(delay_ns); });
    return loop.run(stop.get_token(), call);
  }

  std::stop_source stop;
  std::vector<int64_t> delays_ns;
  std::vector<ConnectionEvent> events;
};

TEST(Backoff, bringsClientsBackWithinTwoSecondsOfTheirServer) {
  Backoff backoff({}, [] { return 0.999; });
  for (int i = 0; i < 20; ++i) EXPECT_LT(backoff.nextDelayNs(), 1'600'000'000);
}

TEST(Backoff, growsToItsLimit) {
  Backoff backoff(kOptions, [] { return 0.5; });
  std::vector<int64_t> delays_ns;
  for (int i = 0; i < 5; ++i) delays_ns.push_back(backoff.nextDelayNs());
  EXPECT_THAT(delays_ns, ElementsAre(100, 200, 400, 450, 450));
  backoff.reset();
  EXPECT_EQ(backoff.nextDelayNs(), 100);
}

TEST(Backoff, jittersByHalfOfTheDelayEitherWay) {
  double random = 0;
  Backoff backoff({.first_ns = 1000, .max_ns = 1000, .factor = 2}, [&] { return random; });
  EXPECT_EQ(backoff.nextDelayNs(), 500);
  random = 0.999;
  EXPECT_EQ(backoff.nextDelayNs(), 1499);
}

TEST(Backoff, drawsDifferentNumbersInEveryClient) {
  std::set<double> drawn;
  for (int client = 0; client < 20; ++client) drawn.insert(makeRandom()());
  EXPECT_GT(drawn.size(), 15U);
  EXPECT_GE(*drawn.begin(), 0.0);
  EXPECT_LT(*drawn.rbegin(), 1.0);
}

TEST(RetryLoop, callsAgainAfterGrowingDelaysUntilItSucceeds) {
  RecordedLoop loop;
  int calls = 0;
  const absl::Status status = loop.run([&] {
    return ++calls < 4 ? unavailable() : CallEnd{absl::OkStatus(), true};
  });
  EXPECT_TRUE(status.ok());
  EXPECT_THAT(loop.delays_ns, ElementsAre(100, 200, 400));
  ASSERT_EQ(loop.events.size(), 3U);
  EXPECT_EQ(loop.events[1].kind, ConnectionEvent::Kind::kRetrying);
  EXPECT_EQ(loop.events[1].delay_ns, 200);
  EXPECT_EQ(loop.events[1].reason.message(), "gone");
}

TEST(RetryLoop, startsAnewAfterACallThatWasConnected) {
  RecordedLoop loop;
  int calls = 0;
  (void)loop.run([&] {
    ++calls;
    return calls < 6 ? unavailable(calls == 4) : CallEnd{absl::OkStatus(), true};
  });
  EXPECT_THAT(loop.delays_ns, ElementsAre(100, 200, 400, 100, 200));
}

TEST(RetryLoop, callsAgainWhateverWayAServerWent) {
  for (const absl::Status& status :
       {absl::UnavailableError("x"), absl::UnknownError("x"), absl::CancelledError("x")}) {
    RecordedLoop loop;
    int calls = 0;
    const absl::Status end = loop.run([&] {
      return ++calls < 2 ? CallEnd{status, true} : CallEnd{absl::OkStatus(), true};
    });
    EXPECT_TRUE(end.ok()) << status;
    EXPECT_EQ(calls, 2) << status;
  }
}

TEST(RetryLoop, givesUpOnWhatWillNotPass) {
  for (const absl::Status& status :
       {absl::InvalidArgumentError("x"), absl::NotFoundError("x"), absl::AlreadyExistsError("x"),
        absl::AbortedError("x"), absl::UnimplementedError("x"), absl::DataLossError("x")}) {
    RecordedLoop loop;
    int calls = 0;
    const absl::Status end = loop.run([&] {
      ++calls;
      return CallEnd{status, true};
    });
    EXPECT_EQ(end, status);
    EXPECT_EQ(calls, 1) << status;
    EXPECT_TRUE(loop.delays_ns.empty());
  }
}

TEST(RetryLoop, endsWhenStoppedWhateverTheCallSays) {
  RecordedLoop loop;
  const absl::Status status = loop.run([&] {
    loop.stop.request_stop();
    return unavailable();
  });
  EXPECT_EQ(status.code(), absl::StatusCode::kCancelled);
  EXPECT_TRUE(loop.delays_ns.empty());
}

TEST(RetryLoop, wakesFromItsRealSleepWhenStopped) {
  std::stop_source stop;
  stop.request_stop();
  constexpr int64_t kHour_ns = 3'600'000'000'000;
  RetryLoop::sleepUntilStopped(stop.get_token(), kHour_ns);  // the test's time limit is minutes
}

// A status with the details that viewloomd's have.
absl::Status fromServer(grpc::StatusCode code, std::optional<int32_t> retry_s = {}) {
  google::rpc::Status details;
  google::rpc::ErrorInfo info;
  info.set_domain("viewloom");
  details.add_details()->PackFrom(info);
  google::rpc::RetryInfo retry;
  retry.mutable_retry_delay()->set_seconds(retry_s.value_or(0));
  if (retry_s) details.add_details()->PackFrom(retry);
  return statusFromGrpc(grpc::Status(code, "no", details.SerializeAsString()));
}

absl::Status fromProxy(grpc::StatusCode code, const std::string& message = "") {
  return statusFromGrpc(grpc::Status(code, message));
}

TEST(IsPassing, isTrueOfWhatProxiesAndBrokenConnectionsDo) {
  for (const auto code :
       {grpc::StatusCode::UNAVAILABLE, grpc::StatusCode::UNKNOWN, grpc::StatusCode::CANCELLED,
        grpc::StatusCode::INTERNAL, grpc::StatusCode::RESOURCE_EXHAUSTED,
        grpc::StatusCode::DEADLINE_EXCEEDED}) {
    EXPECT_TRUE(isPassing(fromProxy(code, "Received RST_STREAM with error code 2"))) << code;
  }
  for (const auto code : {grpc::StatusCode::UNIMPLEMENTED, grpc::StatusCode::PERMISSION_DENIED,
                          grpc::StatusCode::UNAUTHENTICATED}) {
    EXPECT_FALSE(isPassing(fromProxy(code))) << code;
  }
  EXPECT_FALSE(isPassing(fromProxy(grpc::StatusCode::RESOURCE_EXHAUSTED,
                                   "Received message larger than max (5 vs. 4)")));
}

TEST(IsPassing, isFalseOfWhatTheServerRefusesUnlessItDrains) {
  for (const auto code : {grpc::StatusCode::RESOURCE_EXHAUSTED, grpc::StatusCode::INTERNAL,
                          grpc::StatusCode::ALREADY_EXISTS, grpc::StatusCode::INVALID_ARGUMENT,
                          grpc::StatusCode::ABORTED, grpc::StatusCode::NOT_FOUND}) {
    EXPECT_FALSE(isPassing(fromServer(code))) << code;
  }
  EXPECT_TRUE(isPassing(fromServer(grpc::StatusCode::UNAVAILABLE)));
  EXPECT_FALSE(isPassing(absl::ResourceExhaustedError("of the client's own")));
}

TEST(IsPassing, isTrueOfWhatTheServerAsksToRepeat) {
  RecordedLoop loop;
  int calls = 0;
  EXPECT_TRUE(loop.run([&]() -> CallEnd {
                    if (++calls == 3) return {absl::OkStatus(), true};
                    return {fromServer(grpc::StatusCode::ALREADY_EXISTS, 7), false};
                  })
                  .ok());
  EXPECT_THAT(loop.delays_ns, ElementsAre(7'000'000'000, 7'000'000'000));
}

TEST(ExplainBrokenCall, saysWhatToChangeInAProxy) {
  const std::string reset = explainBrokenCall(
      fromProxy(grpc::StatusCode::INTERNAL, "Received RST_STREAM with error code 2"));
  EXPECT_THAT(reset, HasSubstr("grpc_read_timeout"));
  EXPECT_THAT(reset, HasSubstr("error code 2"));
  EXPECT_THAT(explainBrokenCall(
                  fromProxy(grpc::StatusCode::UNKNOWN, "Received http2 header with status: 413")),
              HasSubstr("client_max_body_size 0"));
  EXPECT_EQ(explainBrokenCall(fromServer(grpc::StatusCode::RESOURCE_EXHAUSTED)), "");
  EXPECT_EQ(explainBrokenCall(
                fromProxy(grpc::StatusCode::UNAVAILABLE, "failed to connect to all addresses")),
            "");
}

}  // namespace
}  // namespace viewloom::retry_loop_test
