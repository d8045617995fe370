// SPDX-License-Identifier: Apache-2.0
// The quality that a real socket gets over a line of 100, then 20, then 100 Mbit/s. Atlases are
// bytes without a picture, so that no encoder is measured.
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "base/send_queue.h"
#include "e2e/arrivals.h"
#include "e2e/slow_line.h"
#include "publish/display_coding.h"
#include "support/loopback.h"
#include "support/socket_bytes.h"

namespace viewloom::test::line_control_test {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr int64_t kSecond = 1'000 * kMs;
constexpr uint64_t kReader = 1;
constexpr int64_t kAtlasesApart_ns = kSecond / 30;

int64_t nowNs() {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// A Portrait quilt of the built-in scene.
uint64_t bytesAt(uint32_t qp) {
  return uint64_t(370'000 * std::pow(0.68, (double(qp) - 24) / 4));
}

// Goes before the bytes of each atlas.
struct AtlasHead {
  uint64_t bytes = 0;
  int64_t made_ns = 0;
  uint32_t qp = 0;
};

// A socket that listens on loopback, and the two ends of a connection to it through the line.
class Connection {
 public:
  Connection() {
    line_.emplace(addressOf(listener_), 100);
    EXPECT_TRUE(connectTo(client_, portIn(line_->address())));
    server_ = accept(listener_, nullptr, nullptr);
    limitSendQueue(server_);
  }
  ~Connection() {
    line_.reset();
    for (const int fd : {listener_, client_, server_}) close(fd);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  SlowLine& line() { return *line_; }
  int client() const { return client_; }
  int server() const { return server_; }

 private:
  const int listener_ = listenAnywhere();
  std::optional<SlowLine> line_;
  const int client_ = socket(AF_INET, SOCK_STREAM, 0);
  int server_ = -1;
};

// Makes thirty atlases a second, and writes the newest whenever the socket has the last one.
void writeAtlases(const std::stop_token& stop, int socket, DisplayCoding& coding) {
  std::vector<uint8_t> bytes(bytesAt(24) + sizeof(AtlasHead));
  int64_t next_ns = nowNs();
  while (!stop.stop_requested()) {
    AtlasHead head;
    // Those that were made while the socket was busy are left out, except the newest.
    while (next_ns <= nowNs()) {
      head.made_ns = next_ns;
      head.qp = coding.beginAtlas(nowNs());
      head.bytes = bytesAt(head.qp);
      coding.noteCoded(head.qp, head.bytes);
      next_ns += kAtlasesApart_ns;
    }
    if (head.bytes == 0) {
      std::this_thread::sleep_for(
          std::chrono::nanoseconds(std::max<int64_t>(next_ns - nowNs(), 0)));
      continue;
    }
    std::memcpy(bytes.data(), &head, sizeof(head));
    coding.beginWrite(kReader, head.bytes, nowNs());
    if (!sendAll(socket, bytes.data(), sizeof(head) + head.bytes)) return;
    coding.endAtlas(kReader, nowNs());
  }
}

bool readAll(int socket, uint8_t* bytes, size_t count) {
  return recv(socket, bytes, count, MSG_WAITALL) == ssize_t(count);
}

int64_t medianLatencyNs(const std::vector<Arrival>& arrivals) {
  std::vector<int64_t> latencies_ns;
  for (const Arrival& arrival : arrivals) latencies_ns.push_back(arrival.latency_ns);
  std::ranges::sort(latencies_ns);
  return latencies_ns.empty() ? 0 : latencies_ns[latencies_ns.size() / 2];
}

TEST(LineControl, followsALineDownAndUpWithoutAGap) {
  Connection connection;
  DisplayCoding coding({.color = BandEncoding::kH264, .video_qp = 24, .video_qp_max = 40});
  coding.join(kReader, Payer());
  std::vector<Arrival> arrivals;
  std::jthread reader([&] {
    std::vector<uint8_t> bytes(bytesAt(24));
    AtlasHead head;
    while (readAll(connection.client(), reinterpret_cast<uint8_t*>(&head), sizeof(head)) &&
           readAll(connection.client(), bytes.data(), head.bytes)) {
      const int64_t now_ns = nowNs();
      arrivals.push_back({.at_ns = now_ns,
                          .latency_ns = now_ns - head.made_ns,
                          .bytes = head.bytes,
                          .qp = head.qp});
    }
  });
  std::jthread writer(
      [&](const std::stop_token& stop) { writeAtlases(stop, connection.server(), coding); });
  const auto wait = [](int seconds) {
    std::this_thread::sleep_for(std::chrono::seconds(seconds));
    return nowNs();
  };
  const int64_t begun_ns = wait(1);
  const int64_t slow_ns = wait(5);
  connection.line().setSpeed(20);
  const int64_t middle_ns = wait(5);
  const int64_t again_ns = wait(5);
  connection.line().setSpeed(100);
  const int64_t end_ns = wait(15);
  writer.request_stop();
  writer.join();
  shutdown(connection.server(), SHUT_RDWR);
  shutdown(connection.client(), SHUT_RDWR);
  reader.join();

  const std::vector<Arrival> fast = between(arrivals, begun_ns, slow_ns);
  const std::vector<Arrival> early = between(arrivals, slow_ns + kSecond, middle_ns);
  const std::vector<Arrival> late = between(arrivals, middle_ns, again_ns);
  const std::vector<Arrival> last = between(arrivals, again_ns + kSecond, end_ns);
  for (const auto* const phase : {&fast, &early, &late, &last}) {
    ASSERT_FALSE(phase->empty());
    std::printf("%zu atlases, longest gap %.0f ms, median latency %.0f ms, QP %u at the end\n",
                phase->size(), double(longestGapNs(*phase)) * 1e-6,
                double(medianLatencyNs(*phase)) * 1e-6, phase->back().qp);
  }
  EXPECT_LT(longestGapNs(between(arrivals, begun_ns, end_ns)), 500 * kMs);
  EXPECT_GT(late.back().qp, fast.back().qp);
  EXPECT_LT(last.back().qp, late.back().qp);
  EXPECT_LT(medianLatencyNs(late), medianLatencyNs(early) + 100 * kMs);
}

}  // namespace
}  // namespace viewloom::test::line_control_test
