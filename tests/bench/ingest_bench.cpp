// SPDX-License-Identifier: Apache-2.0
#include "bench/ingest_bench.h"

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <memory>
#include <mutex>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/bare_stream.h"
#include "bench/measured_process.h"
#include "bench/report.h"
#include "e2e/test_server.h"
#include "lib/channel.h"
#include "lib/publisher.h"
#include "offline/median.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr uint32_t kWidth_px = 3840, kHeight_px = 2160;
constexpr int kWarmUpFrames = 3;
constexpr double kMsPerS = 1000;

struct Arguments {
  bool prints_json = false;
  int round_count = 5;
  int frame_count = 30;
  uint32_t miniature = 1;
};

// Colour of 8 bits and depth of floats, of noise: nothing is packed.
WireFrame noiseFrame(uint32_t width_px, uint32_t height_px) {
  WireFrame frame;
  v1::Source& source = *frame.header.add_sources();
  v1::Intrinsics& intrinsics = *source.mutable_camera()->mutable_intrinsics();
  intrinsics.set_focal_x_px(width_px);
  intrinsics.set_focal_y_px(width_px);
  intrinsics.set_principal_x_px(width_px / 2.0);
  intrinsics.set_principal_y_px(height_px / 2.0);
  v1::Layer& layer = *source.add_layers();
  const size_t px_count = size_t{width_px} * height_px;
  std::mt19937 random(1);
  const auto add = [&](v1::PlaneKind kind, v1::PlaneEncoding encoding,
                       std::vector<uint8_t> bytes) -> v1::Plane& {
    v1::Plane& plane = *layer.add_planes();
    plane.set_kind(kind);
    plane.set_encoding(encoding);
    plane.mutable_size()->set_width(width_px);
    plane.mutable_size()->set_height(height_px);
    plane.set_bytes_count(bytes.size());
    frame.planes.push_back(std::make_shared<const std::vector<uint8_t>>(std::move(bytes)));
    return plane;
  };
  std::vector<uint8_t> color(3 * px_count);
  for (uint8_t& code : color) code = uint8_t(random());
  add(v1::PLANE_KIND_COLOR, v1::PLANE_ENCODING_RGB8, std::move(color));
  std::vector<float> depth_m(px_count);
  std::uniform_real_distribution<float> distance_m(1, 10);
  for (float& each : depth_m) each = distance_m(random);
  std::vector<uint8_t> bytes(depth_m.size() * sizeof(float));
  std::memcpy(bytes.data(), depth_m.data(), bytes.size());
  add(v1::PLANE_KIND_DEPTH, v1::PLANE_ENCODING_DEPTH_F32, std::move(bytes))
      .mutable_depth()
      ->set_meaning(v1::DEPTH_MEANING_PLANAR);
  return frame;
}

uint64_t byteCount(const WireFrame& frame) {
  uint64_t count = 0;
  for (const SharedBytes& plane : frame.planes) count += plane->size();
  return count;
}

// One way of getting frames from here to there.
class Way {
 public:
  virtual ~Way() = default;
  virtual void send(int frame_count) = 0;
  // CPU time of the other side so far.
  virtual double thereCpuTime_s() const = 0;
};

class Copies final : public Way {
 public:
  explicit Copies(const WireFrame& frame) : frame_(frame), copy_(byteCount(frame)) {}

  void send(int frame_count) override {
    for (int i = 0; i < frame_count; ++i) {
      size_t offset = 0;
      for (const SharedBytes& plane : frame_.planes) {
        std::memcpy(copy_.data() + offset, plane->data(), plane->size());
        offset += plane->size();
      }
    }
  }
  double thereCpuTime_s() const override { return 0; }

 private:
  const WireFrame& frame_;
  std::vector<uint8_t> copy_;
};

class Bare final : public Way {
 public:
  Bare(const WireFrame& frame, const MeasuredProcess& there)
      : frame_(frame), there_(there), client_(makeChannel(there.address())) {}

  void send(int frame_count) override {
    for (int i = 0; i < frame_count; ++i) client_.send(frame_.planes);
  }
  double thereCpuTime_s() const override { return there_.cpuTime_s(); }

 private:
  const WireFrame& frame_;
  const MeasuredProcess& there_;
  BareClient client_;
};

class Published final : public Way {
 public:
  Published(const WireFrame& frame, const MeasuredProcess& there)
      : frame_(frame),
        there_(there),
        publisher_(makeChannel(there.address()), {.stream = "noise", .backoff = {}},
                   {.on_accepted = {},
                    .on_report = [this](const v1::FrameReport& report) { note(report); },
                    .on_wanted = {},
                    .on_connection = {},
                    .on_sent = {}}) {}

  void send(int frame_count) override {
    for (int i = 0; i < frame_count; ++i) {
      std::unique_lock lock(mutex_);
      // No frame takes the place of one that waits, here or there.
      reported_.wait(lock, [&] { return offered_count_ == reported_count_; });
      ++offered_count_;
      lock.unlock();
      publisher_.offer(frame_);
    }
    std::unique_lock lock(mutex_);
    reported_.wait(lock, [&] { return offered_count_ == reported_count_; });
    if (!refused_.empty()) throw std::runtime_error("a frame was refused: " + refused_);
  }
  double thereCpuTime_s() const override { return there_.cpuTime_s(); }

 private:
  void note(const v1::FrameReport& report) {
    const std::lock_guard lock(mutex_);
    ++reported_count_;
    if (report.outcome() == v1::FRAME_OUTCOME_REFUSED) refused_ = report.reason();
    reported_.notify_all();
  }

  const WireFrame& frame_;
  const MeasuredProcess& there_;
  std::mutex mutex_;
  std::condition_variable reported_;
  int offered_count_ = 0;
  int reported_count_ = 0;
  std::string refused_;
  Publisher publisher_;  // last: it calls back
};

struct Measured {
  std::vector<double> gb_per_s, here_ms, there_ms;
};

void measureRound(Way& way, const Arguments& arguments, uint64_t frame_bytes, Measured& measured) {
  way.send(kWarmUpFrames);
  const double here_s = cpuTime_s();
  const double there_s = way.thereCpuTime_s();
  const auto begin = std::chrono::steady_clock::now();
  way.send(arguments.frame_count);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  const double count = arguments.frame_count;
  measured.gb_per_s.push_back(count * double(frame_bytes) / taken.count() / 1e9);
  measured.here_ms.push_back(kMsPerS * (cpuTime_s() - here_s) / count);
  measured.there_ms.push_back(kMsPerS * (way.thereCpuTime_s() - there_s) / count);
}

void printTable(const Json& json) {
  std::cout << "| way | GB/s | CPU of the publisher, ms a frame | of the server |\n"
            << "|---|---|---|---|\n";
  char row[160];
  for (const Json& way : json["ways"]) {
    std::snprintf(row, sizeof row, "| %s | %.2f | %.1f | %.1f |\n",
                  way["name"].get<std::string>().c_str(), way["gb_per_s"].get<double>(),
                  way["publisher_ms"].get<double>(), way["server_ms"].get<double>());
    std::cout << row;
  }
}

void measureAll(const Arguments& arguments) {
  const WireFrame frame =
      noiseFrame(kWidth_px / arguments.miniature, kHeight_px / arguments.miniature);
  const uint64_t frame_bytes = byteCount(frame);
  // Both before this process has threads.
  const MeasuredProcess bare_server([&] {
    const auto server = std::make_shared<BareServer>(frame_bytes);
    return MeasuredProcess::Running{.parts = server, .address = server->address()};
  });
  const MeasuredProcess viewloom_server([] {
    const auto server = std::make_shared<TestServer>();
    return MeasuredProcess::Running{.parts = server, .address = server->address()};
  });
  Copies copies(frame);
  Bare bare(frame, bare_server);
  Published published(frame, viewloom_server);
  const std::vector<std::pair<const char*, Way*>> ways{
      {"memcpy", &copies}, {"bare gRPC", &bare}, {"viewloom", &published}};
  std::vector<Measured> measured(ways.size());
  for (int round = 0; round < arguments.round_count; ++round) {
    for (size_t i = 0; i < ways.size(); ++i) {
      measureRound(*ways[i].second, arguments, frame_bytes, measured[i]);
    }
  }
  Json json{{"date", today()}, {"frame_bytes", frame_bytes}, {"ways", Json::array()}};
  for (size_t i = 0; i < ways.size(); ++i) {
    json["ways"].push_back({{"name", ways[i].first},
                            {"gb_per_s", medianOf(measured[i].gb_per_s)},
                            {"publisher_ms", medianOf(measured[i].here_ms)},
                            {"server_ms", medianOf(measured[i].there_ms)}});
  }
  if (arguments.prints_json) {
    std::cout << json.dump(2) << "\n";
  } else {
    printTable(json);
  }
}

}  // namespace

void addIngestCommand(const usage::Command& app) {
  const auto arguments = std::make_shared<Arguments>();
  const usage::Command command = app.addCommand(
      "ingest", "Send frames of 3840x2160 to a server in another process, beside gRPC alone");
  command.addFlag("--json", arguments->prints_json, "Print one JSON object instead of a table");
  command.add("--rounds", arguments->round_count, "Rounds, for the medians").between(1, 1000);
  command.add("--frames", arguments->frame_count, "Frames a round").between(1, 100000);
  command
      .add("--miniature", arguments->miniature,
           "A frame so many times smaller on a side: tries the program out")
      .between(1, 32);
  command.onChosen([arguments] { measureAll(*arguments); });
}

}  // namespace viewloom::bench
