// SPDX-License-Identifier: Apache-2.0
#include "bench/side_by_side.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "bench/true_views.h"
#include "offline/median.h"

namespace viewloom::bench {
namespace {

constexpr double kSamePx = 0.5;  // of disparity in the outermost view

template <typename Function>
double timedMs(const Function& function) {
  const auto begin = std::chrono::steady_clock::now();
  function();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

struct Samples {
  std::vector<double> build_ms;
  std::vector<double> trace_ms;
  std::vector<double> total_ms;
};

double differShare(const BenchLoad& load, const std::vector<float>& inv_z,
                   const std::vector<float>& reference) {
  const double same = kSamePx * double{load.source.inv_z_max} / load.disparity_span_px;
  size_t differ_count = 0;
  for (size_t i = 0; i < reference.size(); ++i) {
    const bool hits = inv_z[i] >= 0;
    const bool should_hit = reference[i] >= 0;
    const bool is_apart = std::abs(double{inv_z[i]} - double{reference[i]}) > same;
    differ_count += hits != should_hit || (hits && is_apart);
  }
  return double(differ_count) / double(reference.size());
}

}  // namespace

LoadReport runSideBySide(const BenchLoad& load,
                         const std::vector<std::unique_ptr<Contestant>>& contestants, Work work,
                         int round_count, std::string_view reference) {
  std::vector<Contestant*> taking;
  for (const auto& contestant : contestants) {
    if (contestant->takes(load)) taking.push_back(contestant.get());
  }
  for (Contestant* contestant : taking) contestant->prepare(load);

  std::map<std::string, Samples> samples;
  for (int round = 0; round < round_count; ++round) {
    for (Contestant* contestant : taking) {
      Samples& of = samples[std::string(contestant->name())];
      of.build_ms.push_back(timedMs([&] { contestant->build(); }));
      of.trace_ms.push_back(work == Work::kBuild ? 0 : timedMs([&] { contestant->trace(); }));
      of.total_ms.push_back(of.build_ms.back() + of.trace_ms.back());
    }
  }

  LoadReport report{.load = load.name,
                    .ray_count = load.job.layout->size_px.area(),
                    .disparity_span_px = load.disparity_span_px,
                    .by_contestant = {}};
  std::vector<float> reference_inv_z;
  for (Contestant* contestant : taking) {
    if (work == Work::kBuildAndTrace && contestant->name() == reference) {
      reference_inv_z = contestant->picture().inv_z;
    }
  }
  std::optional<TrueTiles> truth;
  if (work == Work::kBuildAndTrace) truth.emplace(load);
  for (Contestant* contestant : taking) {
    const std::string name(contestant->name());
    Measured measured{.build_ms = medianOf(samples[name].build_ms),
                      .trace_ms = medianOf(samples[name].trace_ms),
                      .total_ms = medianOf(samples[name].total_ms),
                      .differ_share = {},
                      .psnr_db = {}};
    if (truth) {
      const Picture picture = contestant->picture();
      if (!reference_inv_z.empty() && picture.inv_z.size() == reference_inv_z.size()) {
        measured.differ_share = differShare(load, picture.inv_z, reference_inv_z);
      }
      measured.psnr_db = truth->psnrDb(picture.rgba);
    }
    report.by_contestant[name] = measured;
  }
  return report;
}

}  // namespace viewloom::bench
