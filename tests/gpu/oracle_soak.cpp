// SPDX-License-Identifier: Apache-2.0
// viewloom-oracle-soak [first seed [count]]: random scenes and views by the thousand against the
// oracle. Prints every seed that differs; exit code 1 when one did.
#include <charconv>
#include <cstdio>
#include <cstring>

#include "gpu/judge_views.h"
#include "gpu/structure_checks.h"

namespace viewloom {
namespace {

constexpr double kTolerances_px[] = {0.25, 0.05, 0.01};
constexpr uint64_t kProgressEvery = 100;

uint64_t numberOr(const char* text, uint64_t otherwise) {
  uint64_t number = otherwise;
  if (text) std::from_chars(text, text + std::strlen(text), number);
  return number;
}

// One scene with its structure and a view of every kind.
bool agrees(WalkUnderTest& walk, uint64_t seed, JudgedViews& sum) {
  const oracle::Scene scene = oracle::randomScene(seed);
  const std::unique_ptr<StructureSlot> slot = walk.build(*frameOf(scene));
  const oracle::OracleSource source = sourceOf(scene, *slot);
  StructureImage image = walk.readBack(*slot);
  image.kappa_rel = scene.kappa.relative;
  const Complaints complaints = checkStructure(image, source);

  oracle::Random random(seed);
  std::vector<oracle::OutputView> views;
  for (int kind = 0; kind < oracle::kViewKindCount; ++kind) {
    views.push_back(oracle::randomView(random, kind, 13, 10));
  }
  const JudgedViews judged =
      judgeViews(walk, *slot, source, views, kTolerances_px[seed % 3], "soak");
  sum.add(judged);
  if (complaints.empty() && judged.verdict.differing == 0) return true;
  std::printf("seed %llu %s%dx%dx%d\n%s%s\n", static_cast<unsigned long long>(seed),
              scene.name.c_str(), source.width(), source.height(), source.layerCount(),
              complaints.text().c_str(), judged.summary().c_str());
  return false;
}

int soak(uint64_t first, uint64_t count) {
  const Device device(DeviceOptions{});
  WalkUnderTest walk(device);
  JudgedViews sum;
  uint64_t failed_count = 0;
  for (uint64_t seed = first; seed < first + count; ++seed) {
    failed_count += !agrees(walk, seed, sum);
    if ((seed + 1 - first) % kProgressEvery == 0) {
      std::printf("%llu seeds, %llu failed\n", static_cast<unsigned long long>(seed + 1 - first),
                  static_cast<unsigned long long>(failed_count));
      std::fflush(stdout);
    }
  }
  std::printf("%s\n", sum.summary().c_str());
  return failed_count == 0 ? 0 : 1;
}

}  // namespace
}  // namespace viewloom

int main(int argument_count, char** arguments) {
  return viewloom::soak(viewloom::numberOr(argument_count > 1 ? arguments[1] : nullptr, 0),
                        viewloom::numberOr(argument_count > 2 ? arguments[2] : nullptr, 10000));
}
