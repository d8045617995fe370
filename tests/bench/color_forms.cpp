// SPDX-License-Identifier: Apache-2.0
// viewloom-bench-forms: colour in RGB beside the planes that JPEG takes, for who makes them and for
// the encoder. Prints JSON; medians of turns, ns of all cores per px, by the process's own clock:
// what else the machine does counts little. `viewloom-bench-forms [CONE_DEGREES]`.
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <map>
#include <memory>
#include <numbers>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/built_frame.h"
#include "encode/band_encoder.h"
#include "offline/median.h"
#include "support/test_frames.h"

namespace viewloom {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kTurnCount = 9;
constexpr SizePx kSource_px{1920, 1080};
constexpr uint32_t kLayerCount = 2;
constexpr double kRadPerDeg = std::numbers::pi / 180;

struct NamedForm {
  const char* name;
  ColorForm form;
  EncodingSpec encoding;  // of which the form is the direct one, or which takes it as RGB
};
const NamedForm kForms[] = {{"rgb to 4:2:0", ColorForm::kRgba, {.chroma = Chroma::k420}},
                            {"4:2:0", ColorForm::kYcbcr420, {.chroma = Chroma::k420}},
                            {"rgb to 4:4:4", ColorForm::kRgba, {.chroma = Chroma::k444}},
                            {"4:4:4", ColorForm::kYcbcr444, {.chroma = Chroma::k444}}};

double usedNs() {
  timespec used{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return double(used.tv_sec) * 1e9 + double(used.tv_nsec);
}

class FormsBench {
 public:
  FormsBench(const Device& device, const FramePtr& frame, const DisplaySpec& spec)
      : frame_(device, frame),
        job_(frame_.jobOf(spec)),
        plan_(SweepPlan::make(job_, frame_.inv_z_max()).value()) {}

  // One turn of everything, for each form.
  void takeTurn() {
    for (const NamedForm& named : kForms) {
      sweepAndEncode(named);
      walk(named);
    }
  }

  void forgetTurns() { ns_per_px_.clear(); }

  Json results() const {
    Json json;
    for (const auto& [what, by_form] : ns_per_px_) {
      for (const auto& [form, values] : by_form) json[what][form] = medianOf(values);
    }
    return json;
  }

 private:
  const AtlasLayout& layout() const { return *job_.layout; }

  template <typename Work>
  void time(const char* what, const NamedForm& named, const Work& work) {
    const double start_ns = usedNs();
    work();
    ns_per_px_[what][named.name].push_back((usedNs() - start_ns) / double(layout().size_px.area()));
  }

  void sweepAndEncode(const NamedForm& named) {
    SweptAtlas& atlas = atlases_[named.form];
    time("sweep", named, [&] { frame_.sweep(job_, plan_, {.color = named.form}, atlas); });
    time("encode_one_thread", named, [&] {
      encode(named, colorPixels(atlas.color, atlas.ycbcr, layout().size_px, named.form));
    });
  }

  void encode(const NamedForm& named, const BandPixels& pixels) {
    const uint32_t band_rows = bandRowCount(named.encoding);
    for (uint32_t row = 0; row < pixels.row_count; row += band_rows) {
      encoder_.encode(rowsOf(pixels, row, band_rows), named.encoding, layout());
    }
  }

  void walk(const NamedForm& named) {
    const uint32_t band_rows = bandRowCount(named.encoding);
    std::unique_ptr<TraceSlot>& slot = slots_[named.form];
    if (!slot) {
      slot = std::make_unique<TraceSlot>(
          frame_.device(), TraceSlotShape{.width_px = layout().size_px.width,
                                          .row_count_max = band_rows,
                                          .tile_count_max = uint32_t(job_.tiles.size()),
                                          .outputs = {.color = named.form}});
    }
    time("walk", named, [&] { frame_.walk(job_, band_rows, *slot); });
  }

  bench::BuiltFrame frame_;
  const TraceJob job_;
  const SweepPlan plan_;
  BytePool pool_{4};
  BandEncoder encoder_{pool_};
  std::map<ColorForm, SweptAtlas> atlases_;
  std::map<ColorForm, std::unique_ptr<TraceSlot>> slots_;
  std::map<std::string, std::map<std::string, std::vector<double>>> ns_per_px_;
};

int run(double cone_deg) {
  const Device device({});
  QuiltSpec quilt;
  quilt.preset = "portrait";
  quilt.view_cone_rad = cone_deg * kRadPerDeg;
  const DisplaySpec spec = completeDisplaySpec({.kind = quilt, .world_pose = {}}).value();
  FormsBench bench(device, test::syntheticFrame(1, kSource_px, kLayerCount), spec);
  bench.takeTurn();  // compiles, and warms the caches
  bench.forgetTurns();
  for (int turn = 0; turn < kTurnCount; ++turn) bench.takeTurn();
  Json json{{"device", device.info().name}, {"cone_deg", cone_deg}};
  json["cpu_ns_per_px"] = bench.results();
  std::cout << json.dump(2) << "\n";
  return 0;
}

}  // namespace
}  // namespace viewloom

int main(int argc, char** argv) {
  const double cone_deg = argc > 1 ? std::strtod(argv[1], nullptr) : 0.7;
  try {
    return viewloom::run(cone_deg);
  } catch (const std::exception& error) {
    std::cerr << "viewloom-bench-forms: " << error.what() << "\n";
    return 1;
  }
}
