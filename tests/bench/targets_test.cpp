// SPDX-License-Identifier: Apache-2.0
#include "bench/targets.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "bench/load_list.h"

namespace viewloom::bench::targets_test {
namespace {

using Json = nlohmann::ordered_json;

// Every load there is, as swept where its views lie in a row; all figures are alike.
Json allLoads(double figure) {
  Json loads = Json::array();
  for (const NamedLoad& named : fullLoads()) {
    const bool is_row = named.name.find("quilt") != std::string::npos ||
                        named.name.find("one area") != std::string::npos;
    Json load{{"name", named.name}, {"disparity_span_px", 18}};
    for (const char* contestant :
         {"viewloom", "walk", "floor", "copy", "dda", "hiz", "embree", "rows", "runs"}) {
      if (!is_row && std::string(contestant) == "walk") continue;
      for (const char* of : {"build_ms", "ns_per_ray", "total_ms", "psnr_db"}) {
        load[of][contestant] = figure;
      }
    }
    for (const char* own : {"viewloom", "walk"}) {
      if (!is_row && std::string(own) == "walk") continue;
      load["memory_mib"][own] = {{"total", figure}, {"further_frame", figure}};
    }
    load["visits"] = {{"p99", 5}};
    loads.push_back(load);
  }
  return loads;
}

// The names of loads that targets are set for are those of the list.
TEST(Targets, areAllMeasuredByTheLoadsThereAre) {
  std::multiset<std::string> whats;
  for (const Json& ratio : targetRatios(allLoads(1))) whats.insert(ratio.at("what"));
  EXPECT_EQ(whats.count("embree / viewloom, build + trace"), 1U);
  EXPECT_EQ(whats.count("rows / viewloom, build + trace"), 1U);
  EXPECT_EQ(whats.count("viewloom - rows, PSNR in dB"), 1U);
  EXPECT_EQ(whats.count("viewloom / runs, build + trace"), 1U);
  EXPECT_EQ(whats.count("viewloom / floor, trace"), 1U + 4 + 1);  // one axis, any direction, one
  EXPECT_EQ(whats.count("dda / viewloom, trace"), 4U + 1);
  EXPECT_EQ(whats.count("hiz / viewloom, trace"), 4U);
  EXPECT_EQ(whats.count("embree / viewloom, trace"), 4U);
  EXPECT_EQ(whats.count("2-D structure / copy, build"), 1U);
  for (const char* method : {"walk", "sweep"}) {
    const std::string of = std::string(" of the ") + method;
    EXPECT_EQ(whats.count("96 views / 8 views, trace" + of), 1U);
    EXPECT_EQ(whats.count("noise / none, build + trace" + of), 1U);
    EXPECT_EQ(whats.count("noise / dda without noise, build + trace" + of), 1U);
    EXPECT_EQ(whats.count("memory" + of + ", MiB"), 2U);
    EXPECT_EQ(whats.count("further frame / memory" + of), 2U);
  }
}

TEST(Targets, sayWhatIsLost) {
  const Json ratios = targetRatios(allLoads(200));
  const auto find = [&](const std::string& what) {
    return *std::find_if(ratios.begin(), ratios.end(),
                         [&](const Json& ratio) { return ratio.at("what") == what; });
  };
  const Json rows = find("rows / viewloom, build + trace");
  EXPECT_EQ(rows.at("value"), 1.0);
  EXPECT_EQ(rows.at("target"), ">= 1.5");
  EXPECT_EQ(rows.at("is_met"), false);
  const Json runs = find("viewloom / runs, build + trace");
  EXPECT_EQ(runs.at("target"), "<= 2.2");
  EXPECT_EQ(runs.at("is_met"), true);
  EXPECT_EQ(find("memory of the sweep, MiB").at("is_met"), false);
  EXPECT_EQ(find("memory of the sweep, MiB").at("value"), 200.0);
}

TEST(Targets, areLeftOutWhereNothingWasMeasured) {
  EXPECT_EQ(targetRatios(Json::array()), Json::array());
  const Json build{{{"name", "smooth x1, portrait quilt, normal"},
                    {"build_ms", {{"viewloom", 2.0}, {"copy", 1.0}, {"walk", 5.0}}}}};
  const Json ratios = targetRatios(build);
  ASSERT_EQ(ratios.size(), 1U);
  EXPECT_EQ(ratios[0].at("value"), 5.0);
}

}  // namespace
}  // namespace viewloom::bench::targets_test
