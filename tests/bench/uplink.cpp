// SPDX-License-Identifier: Apache-2.0
#include "bench/uplink.h"

#include <chrono>
#include <functional>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/report.h"
#include "decode/plane_decoder.h"
#include "lib/compress_frame.h"
#include "offline/median.h"
#include "synthetic/synthetic_wire_frame.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr SizePx kSize_px{1920, 1080};
constexpr uint32_t kLayerCount = 2;
constexpr double kMsPerS = 1000;

struct Arguments {
  bool prints_json = false;
  int round_count = 5;
  uint32_t miniature = 1;
};

// How a publisher packs a frame.
struct Form {
  const char* name;
  std::function<CompressedFrame(WireFrame)> pack;
};

CompressedFrame packUnpredicted(WireFrame frame) {
  const QuantisedDepth depth = quantiseDepth(*frame.header.mutable_sources(0), frame.planes);
  CompressedFrame packed = compressFrame(std::move(frame), {.zstd_level = 1});
  packed.depth.push_back(depth);
  return packed;
}

std::vector<Form> forms() {
  return {{"f32", [](WireFrame frame) { return compressFrame(std::move(frame), {}); }},
          {"f32, zstd",
           [](WireFrame frame) { return compressFrame(std::move(frame), {.zstd_level = 1}); }},
          {"u16, zstd", packUnpredicted},
          {"u16, predicted, zstd", [](WireFrame frame) {
             return compressFrame(std::move(frame), {.predicts_depth = true});
           }}};
}

// The built-in scene without its colour.
WireFrame depthFrame(SizePx size_px) {
  const WireFrame whole =
      syntheticWireFrame({.size_px = size_px, .layer_count = kLayerCount, .camera = {}}, 1);
  WireFrame frame{.header = whole.header, .planes = {}};
  size_t index = 0;
  for (v1::Layer& layer : *frame.header.mutable_sources(0)->mutable_layers()) {
    const v1::Layer declared = layer;
    layer.clear_planes();
    for (const v1::Plane& plane : declared.planes()) {
      const SharedBytes& bytes = whole.planes.at(index++);
      if (plane.kind() != v1::PLANE_KIND_DEPTH) continue;
      *layer.add_planes() = plane;
      frame.planes.push_back(bytes);
    }
  }
  return frame;
}

PlaneFormat formatOf(const v1::Plane& plane) {
  PlaneFormat format{.kind = PlaneKind::kDepth,
                     .encoding = plane.encoding() == v1::PLANE_ENCODING_DEPTH_F32
                                     ? PlaneEncoding::kDepthF32
                                     : PlaneEncoding::kDepthU16,
                     .size_px = {plane.size().width(), plane.size().height()}};
  if (plane.compression() == v1::PLANE_COMPRESSION_ZSTD) {
    format.compression = PlaneCompression::kZstd;
  }
  if (plane.compression() == v1::PLANE_COMPRESSION_PREDICTED_ZSTD) {
    format.compression = PlaneCompression::kPredictedZstd;
  }
  return format;
}

double timedMs(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return kMsPerS * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Decodes like the server, on one thread.
void decodeAll(const WireFrame& frame, PlaneDecoder& decoder) {
  for (size_t i = 0; i < frame.planes.size(); ++i) {
    const v1::Plane& plane = frame.header.sources(0).layers(static_cast<int>(i)).planes(0);
    const absl::StatusOr<SharedBytes> decoded = decoder.decode(formatOf(plane), frame.planes[i]);
    if (!decoded.ok()) throw std::runtime_error(decoded.status().ToString());
  }
}

Json measure(const Form& form, const WireFrame& frame, int round_count) {
  BytePool pool(8);
  PlaneDecoder decoder(pool);
  CompressedFrame packed;
  std::vector<double> pack_ms;
  std::vector<double> decode_ms;
  for (int round = 0; round < round_count; ++round) {
    pack_ms.push_back(timedMs([&] { packed = form.pack(frame); }) / kLayerCount);
    decode_ms.push_back(timedMs([&] { decodeAll(packed.frame, decoder); }) / kLayerCount);
  }
  size_t bytes = 0;
  for (const SharedBytes& plane : packed.frame.planes) bytes += plane->size();
  const double step = packed.depth.empty() ? 0 : packed.depth.front().step;
  return {{"name", form.name},
          {"mb_per_layer", double(bytes) / kLayerCount / 1e6},
          {"pack_ms_per_layer", medianOf(pack_ms)},
          {"decode_ms_per_layer", medianOf(decode_ms)},
          {"step", step}};
}

void printTable(const Json& json) {
  std::cout << "| depth as | MB per layer | pack, ms | decode, ms | step, 1/m |\n"
            << "|---|---|---|---|---|\n";
  char row[160];
  for (const Json& form : json["forms"]) {
    std::snprintf(row, sizeof row, "| %s | %.2f | %.1f | %.1f | %.2g |\n",
                  form["name"].get<std::string>().c_str(), form["mb_per_layer"].get<double>(),
                  form["pack_ms_per_layer"].get<double>(),
                  form["decode_ms_per_layer"].get<double>(), form["step"].get<double>());
    std::cout << row;
  }
}

void measureAll(const Arguments& arguments) {
  const SizePx size_px{kSize_px.width / arguments.miniature, kSize_px.height / arguments.miniature};
  const WireFrame frame = depthFrame(size_px);
  Json json{{"date", today()},
            {"width_px", size_px.width},
            {"height_px", size_px.height},
            {"layers", kLayerCount},
            {"forms", Json::array()}};
  for (const Form& form : forms()) {
    json["forms"].push_back(measure(form, frame, arguments.round_count));
  }
  if (arguments.prints_json) {
    std::cout << json.dump(2) << "\n";
  } else {
    printTable(json);
  }
}

}  // namespace

void addUplinkCommand(const usage::Command& app) {
  const auto arguments = std::make_shared<Arguments>();
  const usage::Command command =
      app.addCommand("uplink", "Pack and decode the depth of the built-in scene in every form");
  command.addFlag("--json", arguments->prints_json, "Print one JSON object instead of a table");
  command.add("--rounds", arguments->round_count, "Rounds, for the medians").between(1, 1000);
  command
      .add("--miniature", arguments->miniature,
           "A frame so many times smaller on a side: tries the program out")
      .between(1, 32);
  command.onChosen([arguments] { measureAll(*arguments); });
}

}  // namespace viewloom::bench
