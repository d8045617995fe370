// SPDX-License-Identifier: Apache-2.0
#include "bench/video_bench.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/heap.h"
#include "base/str_cat.h"
#include "bench/load_maker.h"
#include "bench/recorded_loads.h"
#include "bench/report.h"
#include "bench/video_coding.h"
#include "bench/viewloom_contestant.h"
#include "offline/manifest_frame.h"
#include "offline/median.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr SizePx kSource_px{1920, 1080};
constexpr double kSpan_px = 18;  // as the other loads'
constexpr uint32_t kQuality = 85;
// Quantisations around the one that the server takes: the error of JPEG lies between them.
constexpr int kQpSteps[] = {-4, -2, 0, 2, 4};
// Sideways places of the moving camera, m.
constexpr double kSways_m[] = {-0.11, 0.02, 0.08};
// Chained atlases: one that needs no other, and those behind it, at 30 Hz.
constexpr int kChainCount = 4;
constexpr double kChainStep_s = 1.0 / 30;
constexpr double kSwaySpeed_m_per_s = 0.2;

struct Arguments {
  bool prints_json = false;
  int round_count = 5;
  uint32_t miniature = 1;
  std::filesystem::path data = VIEWLOOM_SHARED_DATA;
};

NamedLoad builtIn(const std::string& name, double sway_m, double time_s) {
  return {name, [=](const LoadMaker& maker) {
            SyntheticOptions scene{.size_px = maker.sceneSize(kSource_px),
                                   .layer_count = 2,
                                   .time_s = time_s,
                                   .camera = syntheticCamera(maker.sceneSize(kSource_px))};
            scene.camera->pose.position_m.x += sway_m;
            return maker.make(name, makeSyntheticFrame(scene), [](const SourceView& source) {
              return quiltOfSpan(source, "portrait", kSpan_px);
            });
          }};
}

std::vector<NamedLoad> loadsOf(const Arguments& arguments) {
  std::vector<NamedLoad> loads = {builtIn("built-in scene, still", 0, 0)};
  for (const double sway_m : kSways_m) {
    loads.push_back(builtIn(strCat("built-in scene, moving, camera at ", sway_m, " m"), sway_m,
                            10 * std::abs(sway_m)));
  }
  for (NamedLoad& load : recordedLoads(arguments.data).loads) loads.push_back(std::move(load));
  return loads;
}

// Medians of CPU times; all else is the same in each round.
template <typename Code>
Coded measured(int round_count, const Code& code) {
  Coded coded = code();  // warms up
  std::vector<double> encode_ms;
  std::vector<double> decode_ms;
  std::vector<double> library_ms;
  for (int round = 0; round < round_count; ++round) {
    coded = code();
    encode_ms.push_back(coded.encode_ms);
    decode_ms.push_back(coded.decode_ms);
    library_ms.push_back(coded.library_ms);
  }
  coded.encode_ms = medianOf(encode_ms);
  coded.decode_ms = medianOf(decode_ms);
  coded.library_ms = medianOf(library_ms);
  return coded;
}

Json jsonOf(const Coded& coded) {
  return {{"bytes", coded.bytes},
          {"psnr_y_db", coded.psnr_db},
          {"encode_cpu_ms", coded.encode_ms},
          {"decode_cpu_ms", coded.decode_ms},
          {"library_cpu_ms", coded.library_ms}};
}

// Figures between two quantisations at an error; the logarithm of bytes is nearly straight.
// Beyond the ends, the nearest one.
Coded between(const Coded& fine, const Coded& coarse, double psnr_db) {
  const double span_db = fine.psnr_db - coarse.psnr_db;
  const double share = std::clamp((fine.psnr_db - psnr_db) / span_db, 0.0, 1.0);
  const auto mix = [&](double a, double b) { return a + (b - a) * share; };
  return {.bytes =
              uint64_t(std::exp(mix(std::log(double(fine.bytes)), std::log(double(coarse.bytes))))),
          .psnr_db = mix(fine.psnr_db, coarse.psnr_db),
          .encode_ms = mix(fine.encode_ms, coarse.encode_ms),
          .decode_ms = mix(fine.decode_ms, coarse.decode_ms),
          .library_ms = mix(fine.library_ms, coarse.library_ms)};
}

Coded atError(const std::vector<Coded>& codings, double psnr_db) {
  size_t i = 1;
  while (i + 1 < codings.size() && codings[i].psnr_db > psnr_db) ++i;
  return between(codings[i - 1], codings[i], psnr_db);
}

// A camera that moves sideways at so many m/s, and things that move by themselves.
std::vector<NamedLoad> chainOf(const std::string& name, double speed_m_per_s) {
  std::vector<NamedLoad> chain;
  for (int i = 0; i < kChainCount; ++i) {
    const double time_s = i * kChainStep_s;
    chain.push_back(builtIn(name, speed_m_per_s * time_s, time_s));
  }
  return chain;
}

Coded meanOf(const std::vector<Coded>& all) {
  Coded mean;
  double bytes = 0;
  for (const Coded& one : all) {
    bytes += double(one.bytes) / double(all.size());
    mean.psnr_db += one.psnr_db / double(all.size());
    mean.encode_ms += one.encode_ms / double(all.size());
    mean.decode_ms += one.decode_ms / double(all.size());
    mean.library_ms += one.library_ms / double(all.size());
  }
  mean.bytes = uint64_t(bytes);
  return mean;
}

// The mean of the atlases that refer to others; `first`: the one that does not.
Coded codeChain(std::deque<VideoCoding>& codings, uint32_t qp, Coded& first) {
  ChainEnds chain;
  std::vector<Coded> others;
  for (VideoCoding& coding : codings) others.push_back(coding.asChained(qp, chain));
  first = others.front();
  others.erase(others.begin());
  return meanOf(others);
}

Json measureChain(const Device& device, const LoadMaker& maker, const std::string& name,
                  double speed_m_per_s, const Arguments& arguments) {
  std::deque<VideoCoding> codings;  // which do not move
  for (const NamedLoad& load : chainOf(name, speed_m_per_s)) {
    const BenchLoad made = load.make(maker);
    ViewloomContestant viewloom(device, true);
    viewloom.prepare(made);
    viewloom.build();
    viewloom.trace();
    codings.emplace_back(*made.job.layout, viewloom.picture().rgba);
  }
  const Coded jpeg = measured(arguments.round_count, [&] {
    std::vector<Coded> all;
    for (VideoCoding& coding : codings) all.push_back(coding.asJpeg(kQuality));
    return meanOf(all);
  });
  std::vector<Coded> firsts(std::size(kQpSteps));
  std::vector<Coded> chains;
  for (const int step : kQpSteps) {
    const auto qp = uint32_t(int(matchedVideoQp(kQuality)) + step);
    Coded& first = firsts[chains.size()];
    chains.push_back(
        measured(arguments.round_count, [&] { return codeChain(codings, qp, first); }));
  }
  const Coded same = atError(chains, jpeg.psnr_db);
  const Coded first = atError(firsts, jpeg.psnr_db);
  return {{"name", name},
          {"pictures", codings.front().pictureCount()},
          {"jpeg_quality", kQuality},
          {"jpeg", jsonOf(jpeg)},
          {"h264_at_psnr_of_jpeg", jsonOf(same)},
          {"first_bytes", first.bytes},
          {"smaller", double(jpeg.bytes) / double(same.bytes)},
          {"encode_cpu", same.encode_ms / jpeg.encode_ms},
          {"decode_cpu", same.decode_ms / jpeg.decode_ms},
          {"library_cpu", same.library_ms / jpeg.decode_ms}};
}

Json measureLoad(const Device& device, const BenchLoad& load, const Arguments& arguments) {
  ViewloomContestant viewloom(device, true);
  viewloom.prepare(load);
  viewloom.build();
  viewloom.trace();
  VideoCoding coding(*load.job.layout, viewloom.picture().rgba);
  const Coded jpeg = measured(arguments.round_count, [&] { return coding.asJpeg(kQuality); });
  Json json{{"name", load.name},
            {"pictures", coding.pictureCount()},
            {"jpeg_quality", kQuality},
            {"jpeg", jsonOf(jpeg)},
            {"h264", Json::array()}};
  std::vector<Coded> codings;
  for (const int step : kQpSteps) {
    const auto qp = uint32_t(int(matchedVideoQp(kQuality)) + step);
    codings.push_back(measured(arguments.round_count, [&] { return coding.asVideo(qp); }));
    Json one = jsonOf(codings.back());
    one["qp"] = qp;
    json["h264"].push_back(std::move(one));
  }
  const Coded same = atError(codings, jpeg.psnr_db);
  json["h264_at_psnr_of_jpeg"] = jsonOf(same);
  json["smaller"] = double(jpeg.bytes) / double(same.bytes);
  json["encode_cpu"] = same.encode_ms / jpeg.encode_ms;
  json["decode_cpu"] = same.decode_ms / jpeg.decode_ms;
  json["library_cpu"] = same.library_ms / jpeg.decode_ms;
  return json;
}

void printTable(const Json& json) {
  std::cout << "| atlas | JPEG KB | dB | H.264 KB | dB | smaller | encode CPU | decode CPU "
               "| OpenH264 of it |\n"
            << "|---|---|---|---|---|---|---|---|---|\n";
  char row[240];
  Json all = json["loads"];
  for (const Json& chain : json["chained"]) all.push_back(chain);
  for (const Json& load : all) {
    const Json& jpeg = load["jpeg"];
    const Json& video = load["h264_at_psnr_of_jpeg"];
    std::snprintf(row, sizeof row,
                  "| %s | %.0f | %.2f | %.0f | %.2f | %.2f | %.2f | %.2f | %.2f |\n",
                  load["name"].get<std::string>().c_str(), jpeg["bytes"].get<double>() / 1e3,
                  jpeg["psnr_y_db"].get<double>(), video["bytes"].get<double>() / 1e3,
                  video["psnr_y_db"].get<double>(), load["smaller"].get<double>(),
                  load["encode_cpu"].get<double>(), load["decode_cpu"].get<double>(),
                  load["library_cpu"].get<double>());
    std::cout << row;
  }
}

void measureAll(const Arguments& arguments) {
  keepFreedMemory();  // as both programs do: fresh memory takes as long as decoding a JPEG
  const Device device({});
  const LoadMaker maker(device, arguments.miniature);
  Json json{{"date", today()}, {"device", device.info().name}, {"loads", Json::array()}};
  for (const NamedLoad& load : loadsOf(arguments)) {
    json["loads"].push_back(measureLoad(device, load.make(maker), arguments));
  }
  json["chained"] =
      Json::array({measureChain(device, maker, "built-in scene, chained, still", 0, arguments),
                   measureChain(device, maker, "built-in scene, chained, moving",
                                kSwaySpeed_m_per_s, arguments)});
  json["skipped"] = Json::array();
  for (const SkippedLoad& skipped : recordedLoads(arguments.data).skipped) {
    json["skipped"].push_back({{"name", skipped.name}, {"reason", skipped.reason}});
  }
  if (arguments.prints_json) {
    std::cout << json.dump(2) << "\n";
  } else {
    printTable(json);
  }
}

}  // namespace

void addVideoCommand(const usage::Command& app) {
  const auto arguments = std::make_shared<Arguments>();
  const usage::Command command =
      app.addCommand("video", "Portrait quilts as H.264 beside JPEG of the same error");
  command.addFlag("--json", arguments->prints_json, "Print one JSON object instead of a table");
  command.add("--rounds", arguments->round_count, "Rounds, for the medians").between(1, 1000);
  command
      .add("--miniature", arguments->miniature,
           "Scenes and tiles so many times smaller on a side: tries the program out")
      .between(1, 32);
  command.onChosen([arguments] { measureAll(*arguments); });
}

}  // namespace viewloom::bench
