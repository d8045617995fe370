// SPDX-License-Identifier: Apache-2.0
#include "bench/targets.h"

#include <optional>
#include <sstream>
#include <string>

#include "base/str_cat.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kMain = "clutter x2, portrait quilt, normal";
constexpr const char* kNoisy = "clutter x2, noise 0.4 px, portrait quilt, normal";
constexpr const char* k4K = "clutter x4, 4K, 32_gen3_l quilt, normal";
constexpr const char* kFewViews = "clutter x2, 8 views of one area, normal";
constexpr const char* kManyViews = "clutter x2, 96 views of one area, normal";
constexpr const char* kOneRotated = "clutter x2, one rotated view, normal";
constexpr const char* kAnyDirection[] = {
    "clutter x2, 8x8 parallax, normal", "clutter x2, 8x8 parallax, wide",
    "clutter x2, 8x8 parallax, extreme", "clutter x2, stepping camera, normal"};

struct Bound {
  const char* sign;  // ">= " or "<= "
  double value;
};
Bound atLeast(double value) {
  return {">= ", value};
}
Bound atMost(double value) {
  return {"<= ", value};
}

std::optional<double> figureOf(const Json& load, const char* figure, const std::string& of) {
  const auto found = load.find(figure);
  if (found == load.end() || !found->contains(of)) return std::nullopt;
  return found->at(of).get<double>();
}

bool isSwept(const Json& load) {
  return load.contains("build_ms") && load.at("build_ms").contains("walk");
}
// The contestant that is viewloom's walk.
const char* walkOf(const Json& load) {
  return isSwept(load) ? "walk" : "viewloom";
}

class Targets {
 public:
  explicit Targets(const Json& loads) : loads_(loads) {}

  void noteOneAxis();
  void noteAnyDirection();
  void noteBuilds();
  void noteViewCounts();
  void noteNoise();
  void noteVisits();
  void noteMemory(const char* load_name, double total_mib_max);
  Json take() { return std::move(ratios_); }

 private:
  const Json* find(const std::string& name) const {
    for (const Json& load : loads_) {
      if (load.at("name") == name) return &load;
    }
    return nullptr;
  }
  void add(const Json& load, const std::string& what, std::optional<double> value,
           const Bound& bound) {
    if (!value) return;
    std::ostringstream target;
    target << bound.sign << bound.value;
    const bool is_met = bound.sign[0] == '>' ? *value >= bound.value : *value <= bound.value;
    ratios_.push_back({{"what", what},
                       {"load", load.at("name")},
                       {"value", *value},
                       {"target", target.str()},
                       {"is_met", is_met}});
  }
  // One contestant's figure over another's, maybe of another load.
  void addRatio(const Json& load, const char* figure, const std::string& of, const Json& to_load,
                const std::string& to, const std::string& what, const Bound& bound) {
    const std::optional<double> value = figureOf(load, figure, of);
    const std::optional<double> by = figureOf(to_load, figure, to);
    if (value && by && *by > 0) add(load, what, *value / *by, bound);
  }

  const Json& loads_;
  Json ratios_ = Json::array();
};

void Targets::noteOneAxis() {
  const Json* const load = find(kMain);
  if (load == nullptr || !load->contains("total_ms")) return;
  addRatio(*load, "total_ms", "embree", *load, "viewloom", "embree / viewloom, build + trace",
           atLeast(30));
  addRatio(*load, "total_ms", "rows", *load, "viewloom", "rows / viewloom, build + trace",
           atLeast(1.5));
  const std::optional<double> own_db = figureOf(*load, "psnr_db", "viewloom");
  const std::optional<double> rows_db = figureOf(*load, "psnr_db", "rows");
  if (own_db && rows_db) {
    add(*load, "viewloom - rows, PSNR in dB", *own_db - *rows_db, atLeast(0));
  }
  addRatio(*load, "total_ms", "viewloom", *load, "runs", "viewloom / runs, build + trace",
           atMost(2.2));
  addRatio(*load, "ns_per_ray", "viewloom", *load, "floor", "viewloom / floor, trace", atMost(2));
}

void Targets::noteAnyDirection() {
  const auto note = [&](const Json& load, const char* rival, double least) {
    addRatio(load, "ns_per_ray", rival, load, "viewloom", strCat(rival, " / viewloom, trace"),
             atLeast(least));
  };
  const auto noteFloor = [&](const Json& load, double most) {
    addRatio(load, "ns_per_ray", "viewloom", load, "floor", "viewloom / floor, trace",
             atMost(most));
  };
  for (const char* name : kAnyDirection) {
    const Json* const load = find(name);
    if (load == nullptr) continue;
    note(*load, "dda", 6);
    note(*load, "hiz", 2.5);
    note(*load, "embree", 8);
    noteFloor(*load, 3.5);
  }
  if (const Json* const load = find(kOneRotated)) {
    note(*load, "dda", 4);
    noteFloor(*load, 6);
  }
}

// Where builds alone are measured, of all loads.
void Targets::noteBuilds() {
  for (const Json& load : loads_) {
    if (load.contains("total_ms") && load.at("name") != kMain) continue;
    addRatio(load, "build_ms", walkOf(load), load, "copy", "2-D structure / copy, build",
             atMost(2.5));
  }
}

void Targets::noteViewCounts() {
  const Json* const few = find(kFewViews);
  const Json* const many = find(kManyViews);
  if (few == nullptr || many == nullptr) return;
  addRatio(*many, "ns_per_ray", walkOf(*many), *few, walkOf(*few),
           "96 views / 8 views, trace of the walk", atMost(1.1));
  if (!isSwept(*many)) return;
  addRatio(*many, "ns_per_ray", "viewloom", *few, "viewloom",
           "96 views / 8 views, trace of the sweep", atMost(1.3));
}

void Targets::noteNoise() {
  const Json* const clean = find(kMain);
  const Json* const noisy = find(kNoisy);
  if (clean == nullptr || noisy == nullptr) return;
  const auto note = [&](const std::string& own, const char* method, double most) {
    addRatio(*noisy, "total_ms", own, *clean, own,
             strCat("noise / none, build + trace of the ", method), atMost(most));
    addRatio(*noisy, "total_ms", own, *clean, "dda",
             strCat("noise / dda without noise, build + trace of the ", method), atMost(1));
  };
  note(walkOf(*noisy), "walk", 2.5);
  if (isSwept(*noisy)) note("viewloom", "sweep", 3);
}

void Targets::noteVisits() {
  constexpr double kSpanMax_px = 100;
  for (const Json& load : loads_) {
    if (!load.contains("visits") || load.at("disparity_span_px") > kSpanMax_px) continue;
    add(load, "visits per ray, p99", load.at("visits").at("p99").get<double>(), atMost(24));
  }
}

void Targets::noteMemory(const char* load_name, double total_mib_max) {
  const Json* const load = find(load_name);
  if (load == nullptr || !load->contains("memory_mib")) return;
  for (const auto& [name, memory] : load->at("memory_mib").items()) {
    const std::string method = name == walkOf(*load) ? "walk" : "sweep";
    const double total_mib = memory.at("total");
    add(*load, strCat("memory of the ", method, ", MiB"), total_mib, atMost(total_mib_max));
    add(*load, strCat("further frame / memory of the ", method),
        memory.at("further_frame").get<double>() / total_mib, atMost(0.5));
  }
}

}  // namespace

Json targetRatios(const Json& loads) {
  Targets targets(loads);
  targets.noteOneAxis();
  targets.noteAnyDirection();
  targets.noteBuilds();
  targets.noteViewCounts();
  targets.noteNoise();
  targets.noteVisits();
  targets.noteMemory(kMain, 160);
  targets.noteMemory(k4K, 1024);
  return targets.take();
}

}  // namespace viewloom::bench
