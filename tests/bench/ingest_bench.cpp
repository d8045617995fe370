// SPDX-License-Identifier: Apache-2.0
#include "bench/ingest_bench.h"

#include <chrono>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/heap.h"
#include "bench/bare_stream.h"
#include "bench/endless_atlases.h"
#include "bench/measured_process.h"
#include "bench/report.h"
#include "bench/stream_ways.h"
#include "e2e/test_server.h"
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
  std::cout << "| way | GB/s | CPU time of this side, ms a frame | of the server |\n"
            << "|---|---|---|---|\n";
  char row[160];
  for (const Json& way : json["ways"]) {
    std::snprintf(row, sizeof row, "| %s | %.2f | %.1f | %.1f |\n",
                  way["name"].get<std::string>().c_str(), way["gb_per_s"].get<double>(),
                  way["client_ms"].get<double>(), way["server_ms"].get<double>());
    std::cout << row;
  }
}

template <typename Server, typename... Arguments>
MeasuredProcess processOf(Arguments... arguments) {
  return MeasuredProcess([=] {
    const auto server = std::make_shared<Server>(arguments...);
    return MeasuredProcess::Running{.parts = server, .address = server->address()};
  });
}

struct NamedWay {
  const char* name;
  uint64_t frame_bytes;
  std::unique_ptr<Way> way;
  Measured measured;
};

void measureAll(const Arguments& arguments) {
  keepFreedMemory();  // as both programs do, and before the others fork
  const uint32_t width_px = kWidth_px / arguments.miniature;
  const uint32_t height_px = kHeight_px / arguments.miniature;
  const WireFrame frame = noiseFrame(width_px, height_px);
  const uint64_t frame_bytes = byteCount(frame);
  const uint64_t atlas_bytes = uint64_t{3} * width_px * height_px;
  // All before this process has threads.
  const MeasuredProcess bare_taker = processOf<BareServer>(frame_bytes);
  const MeasuredProcess keeping_taker = processOf<BareServer>(frame_bytes, Received::kKept);
  const MeasuredProcess taker = processOf<TestServer>();
  const MeasuredProcess bare_giver = processOf<BareServer>(atlas_bytes);
  const MeasuredProcess bare_keeper = processOf<BareServer>(atlas_bytes);
  const MeasuredProcess giver = processOf<EndlessAtlases>();
  std::vector<NamedWay> ways;
  const auto add = [&](const char* name, uint64_t bytes, std::unique_ptr<Way> way) {
    ways.push_back({.name = name, .frame_bytes = bytes, .way = std::move(way), .measured = {}});
  };
  add("memcpy", frame_bytes, copyWay(frame));
  add("frames in, gRPC alone", frame_bytes, bareSendingWay(frame, bare_taker));
  add("frames in, gRPC and one copy", frame_bytes, bareSendingWay(frame, keeping_taker));
  add("frames in", frame_bytes, publishingWay(frame, taker));
  add("atlases out, gRPC alone", atlas_bytes, bareReceivingWay(atlas_bytes, bare_giver));
  add("atlases out, gRPC and one copy", atlas_bytes, bareKeepingWay(atlas_bytes, bare_keeper));
  add("atlases out", atlas_bytes, watchingWay(width_px, height_px, giver));
  for (int round = 0; round < arguments.round_count; ++round) {
    for (NamedWay& way : ways) measureRound(*way.way, arguments, way.frame_bytes, way.measured);
  }
  Json json{{"date", today()}, {"ways", Json::array()}};
  for (const NamedWay& way : ways) {
    json["ways"].push_back({{"name", way.name},
                            {"frame_bytes", way.frame_bytes},
                            {"gb_per_s", medianOf(way.measured.gb_per_s)},
                            {"client_ms", medianOf(way.measured.here_ms)},
                            {"server_ms", medianOf(way.measured.there_ms)}});
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
      "ingest", "Frames of 3840x2160 into a server and atlases out of it, beside gRPC alone");
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
