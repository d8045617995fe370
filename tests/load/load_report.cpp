// SPDX-License-Identifier: Apache-2.0
#include "load/load_report.h"

#include <algorithm>

namespace viewloom::load {
namespace {

using nlohmann::json;

json percentilesJson(const Percentiles& samples) {
  return {{"p50_ms", samples.atMs(0.5)}, {"p99_ms", samples.atMs(0.99)}};
}

json publisherJson(const PublisherBook& book) {
  return {{"stream", book.stream},
          {"offered", book.counts.offered},
          {"sent", book.counts.sent},
          {"sent_bytes", book.counts.sent_bytes},
          {"traced", book.traced},
          {"built_without_display", book.built_without_display},
          {"replaced_before_sending", book.counts.replaced_here},
          {"replaced_on_server", book.counts.replaced_there},
          {"refused", book.counts.refused}};
}

json displayJson(const DisplayBook& book, double seconds) {
  return {{"stream", book.stream},
          {"kind", book.kind},
          {"slow", book.is_slow},
          {"atlases", book.counts.atlases.whole},
          {"atlases_per_s", static_cast<double>(book.counts.atlases.whole) / seconds},
          {"bytes_per_s", static_cast<double>(book.counts.received_bytes) / seconds},
          {"skipped", book.counts.atlases.skipped},
          {"capture_to_arrival", percentilesJson(book.latency)}};
}

// Over all displays that keep up: a slow one measures itself.
json stagesJson(const LoadResult& result) {
  std::map<std::string, Percentiles> stages;
  for (const DisplayBook& book : result.displays) {
    if (book.is_slow) continue;
    for (const auto& [stage, samples] : book.stages) stages[stage].add(samples);
  }
  json report = json::object();
  for (const auto& [stage, samples] : stages) report[stage] = percentilesJson(samples);
  return report;
}

// Drops by hand-over, in the order in which a frame meets them.
json dropsJson(const LoadResult& result) {
  uint64_t before_sending = 0;
  for (const PublisherBook& book : result.publishers) before_sending += book.counts.replaced_here;
  json report = {{"publisher", before_sending}};
  for (const char* hand_over : {"decode", "structure", "trace", "grpc"}) {
    const auto found = result.metrics.find("viewloom_replaced_total{hand_over=\"" +
                                           std::string(hand_over) + "\"}");
    if (found != result.metrics.end()) report[hand_over] = found->second;
  }
  return report;
}

json serverJson(const LoadOptions& options, const LoadResult& result) {
  if (result.server_usage.empty()) return nullptr;
  const auto peak = std::max_element(
      result.server_usage.begin(), result.server_usage.end(),
      [](const auto& a, const auto& b) { return a.resident_bytes < b.resident_bytes; });
  const double cpu_s = static_cast<double>(result.server_usage.back().cpu_ns) / 1e9;
  return {
      {"resident_bytes_peak", peak->resident_bytes},
      {"resident_bytes_end", result.server_usage.back().resident_bytes},
      {"cpu_cores", cpu_s / result.seconds},
      {"cpu_cores_per_client", cpu_s / result.seconds / (options.publishers + options.displays)},
      {"exit_code", result.server_exit_code}};
}

}  // namespace

json makeReport(const LoadOptions& options, const LoadResult& result) {
  json report{{"seconds", result.seconds},
              {"frame",
               {{"width", options.size_px.width},
                {"height", options.size_px.height},
                {"layers", options.layer_count},
                {"rate_hz", options.rate_hz}}},
              {"publishers", json::array()},
              {"displays", json::array()},
              {"stages", stagesJson(result)},
              {"drops", dropsJson(result)},
              {"server", serverJson(options, result)}};
  double atlases = 0;
  double bytes = 0;
  for (const PublisherBook& book : result.publishers) {
    report["publishers"].push_back(publisherJson(book));
  }
  for (const DisplayBook& book : result.displays) {
    report["displays"].push_back(displayJson(book, result.seconds));
    atlases += static_cast<double>(book.counts.atlases.whole);
    bytes += static_cast<double>(book.counts.received_bytes);
  }
  report["goodput"] = {{"atlases_per_s", atlases / result.seconds},
                       {"bytes_per_s", bytes / result.seconds}};
  report["clients"] = {{"cpu_cores_per_client", static_cast<double>(result.client_usage.cpu_ns) /
                                                    1e9 / result.seconds /
                                                    (options.publishers + options.displays)}};
  report["problems"] = findProblems(options, result);
  return report;
}

}  // namespace viewloom::load
