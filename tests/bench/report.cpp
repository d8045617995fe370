// SPDX-License-Identifier: Apache-2.0
#include "bench/report.h"

#include <ctime>
#include <iomanip>
#include <sstream>

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

// "-" where a contestant has no such figure.
std::string cell(const Json& load, const char* figure, const std::string& contestant,
                 double factor) {
  const auto of_all = load.find(figure);
  if (of_all == load.end() || !of_all->contains(contestant)) return "-";
  std::ostringstream text;
  text << std::setprecision(4) << of_all->at(contestant).get<double>() * factor;
  return text.str();
}

Json memoryJson(const MemoryUse& use) {
  constexpr double kMib = 1 << 20;
  Json json{{"structure", double(use.structure_bytes) / kMib},
            {"trace_target", double(use.trace_target_bytes) / kMib},
            {"frame_input", double(use.frame_input_bytes) / kMib},
            {"total", double(use.totalBytes()) / kMib}};
  if (use.peak_bytes) json["peak"] = double(*use.peak_bytes) / kMib;
  json["further_frame"] = double(use.further_frame_bytes) / kMib;
  return json;
}

}  // namespace

Json buildJson(const LoadReport& report) {
  Json json{{"name", report.load}};
  for (const auto& [name, measured] : report.by_contestant) {
    json["build_ms"][name] = measured.build_ms;
  }
  return json;
}

Json traceJson(const LoadReport& report, const OwnReport& own) {
  const bool is_swept = own.method == TraceMethod::kSweep;
  Json json{{"name", report.load},
            {"rays", report.ray_count},
            {"disparity_span_px", report.disparity_span_px},
            {"method", is_swept ? "sweep" : "walk"}};
  const auto rays = static_cast<double>(report.ray_count);
  for (const auto& [name, measured] : report.by_contestant) {
    json["build_ms"][name] = measured.build_ms;
    json["ns_per_ray"][name] = measured.trace_ms * 1e6 / rays;
    json["total_ms"][name] = measured.total_ms;
    if (measured.differ_share) json["differ_share"][name] = *measured.differ_share;
    if (measured.psnr_db) json["psnr_db"][name] = *measured.psnr_db;
  }
  json["visits"] = {{"mean", own.visits.mean},
                    {"p99", own.visits.p99},
                    {"max", own.visits.max},
                    {"slowest_8x8_sum", own.visits.slowest_block_sum}};
  if (own.sweep) json["memory_mib"]["viewloom"] = memoryJson(*own.sweep);
  json["memory_mib"][is_swept ? "walk" : "viewloom"] = memoryJson(own.walk);
  return json;
}

std::string asTable(const Json& load) {
  std::ostringstream text;
  text << load.at("name").get<std::string>() << "\n"
       << std::left << std::setw(12) << "" << std::right << std::setw(12) << "build ms"
       << std::setw(12) << "ns/ray" << std::setw(12) << "total ms" << std::setw(12) << "differ %"
       << std::setw(12) << "psnr dB"
       << "\n";
  for (const auto& [name, unused] : load.at("build_ms").items()) {
    text << "  " << std::left << std::setw(10) << name << std::right << std::setw(12)
         << cell(load, "build_ms", name, 1) << std::setw(12) << cell(load, "ns_per_ray", name, 1)
         << std::setw(12) << cell(load, "total_ms", name, 1) << std::setw(12)
         << cell(load, "differ_share", name, 100) << std::setw(12) << cell(load, "psnr_db", name, 1)
         << "\n";
  }
  return text.str();
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[sizeof "2000-01-01"];
  std::strftime(text, sizeof text, "%Y-%m-%d", &utc);
  return text;
}

}  // namespace viewloom::bench
