// SPDX-License-Identifier: Apache-2.0
#include "files/deep_layers.h"

#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <span>
#include <utility>

#include "base/str_cat.h"
#include "deep/split_pixel.h"
#include "deep/tidy_pixel.h"
#include "files/deep_exr.h"
#include "files/file_bytes.h"
#include "files/plane_image.h"

namespace viewloom::files {
namespace {

constexpr size_t kColorBytes = 8;  // a px
constexpr size_t kDepthBytes = 4;
// Bytes of all planes together: the server's limit for a frame.
constexpr uint64_t kLayersBytesMax = uint64_t{3} << 29;
// Half a step of binary16 below 1: less cannot be told from an opaque px.
constexpr double kOpaque = 1 - 1.0 / 4096;

uint16_t halfBits(double value) {
  return Imath::half(static_cast<float>(std::clamp<double>(value, -kHalfMax, kHalfMax))).bits();
}

// Layers as they fill. A layer that no px needs is never made.
class LayerPlanes {
 public:
  explicit LayerPlanes(size_t pixel_count) : pixel_count_(pixel_count) { addLayer(); }

  void put(size_t pixel, const deep::SplitPixel& split) {
    while (colors_.size() < split.layer_count) addLayer();
    for (uint32_t i = 0; i < split.layer_count; ++i) {
      const deep::DeepPoint& point = split.layers[i];
      const uint16_t rgba[4] = {halfBits(point.color.r), halfBits(point.color.g),
                                halfBits(point.color.b), halfBits(point.alpha)};
      static_assert(sizeof rgba == kColorBytes);
      std::memcpy(&colors_[i][kColorBytes * pixel], rgba, kColorBytes);
      const auto depth_m = static_cast<float>(1 / point.inv_z);  // 1/0: the sky is at infinity
      std::memcpy(&depths_[i][kDepthBytes * pixel], &depth_m, kDepthBytes);
    }
  }

  size_t layerCount() const { return colors_.size(); }
  std::vector<uint8_t> takeColor(size_t layer) { return std::move(colors_[layer]); }
  std::vector<uint8_t> takeDepth(size_t layer) { return std::move(depths_[layer]); }

 private:
  void addLayer() {
    colors_.emplace_back(kColorBytes * pixel_count_);
    depths_.emplace_back(kDepthBytes * pixel_count_);
  }

  size_t pixel_count_;
  std::vector<std::vector<uint8_t>> colors_;
  std::vector<std::vector<uint8_t>> depths_;
};

absl::Status checkDepth(const v1::DepthFormat& depth) {
  if (depth.meaning() != v1::DEPTH_MEANING_PLANAR &&
      depth.meaning() != v1::DEPTH_MEANING_RAY_DISTANCE) {
    return invalidField("depth.meaning",
                        strCat("is ", v1::DepthMeaning_Name(depth.meaning()),
                               "; accepted for deep files are DEPTH_MEANING_PLANAR and "
                               "_RAY_DISTANCE"));
  }
  if (!std::isfinite(depth.scale()) || !std::isfinite(depth.offset())) {
    return invalidField("depth.scale", "and offset must be finite");
  }
  if (depth.has_invalid_value() || depth.invalid_is_far()) {
    return invalidField("depth.invalid_value",
                        "is given; in deep files, a px without a surface has no sample");
  }
  return absl::OkStatus();
}

class DeepSplit {
 public:
  DeepSplit(DeepExr& file, uint32_t layer_count_max, bool has_black_sky)
      : file_(file),
        splitter_(layer_count_max),
        has_black_sky_(has_black_sky),
        planes_(size_t{file.widthPx()} * file.heightPx()),
        is_seen_(has_black_sky ? size_t{file.widthPx()} * file.heightPx() : 0) {}

  absl::Status run() {
    VIEWLOOM_RETURN_IF_ERROR(file_.forEachRow([this](const DeepRow& row) { take(row); }));
    // Where the file has no data there is sky as well.
    for (size_t pixel = 0; pixel < is_seen_.size(); ++pixel) {
      if (!is_seen_[pixel]) put(pixel, {});
    }
    report_.dropped_sample_count = tidier_.droppedCount();
    report_.layer_count = static_cast<uint32_t>(planes_.layerCount());
    if (report_.pixel_count > 0) {
      report_.error_mean_per_m = error_sum_per_m_ / static_cast<double>(report_.pixel_count);
    }
    return absl::OkStatus();
  }

  LayerPlanes& planes() { return planes_; }
  const DeepReport& report() const { return report_; }

 private:
  void take(const DeepRow& row) {
    size_t begin = 0;
    for (size_t i = 0; i < row.counts.size(); ++i) {
      put(size_t{row.y} * file_.widthPx() + row.x + i, row.samples.subspan(begin, row.counts[i]));
      begin += row.counts[i];
    }
  }

  void put(size_t pixel, std::span<const deep::DeepSample> samples) {
    const auto tidy = tidier_.tidy(samples);
    points_.assign(tidy.begin(), tidy.end());
    if (has_black_sky_) {
      is_seen_[pixel] = true;
      if (points_.empty() || deep::joined(points_).alpha < kOpaque) {
        points_.push_back({.inv_z = 0, .alpha = 1, .color = glm::dvec3(0)});
      }
    }
    const deep::SplitPixel split = splitter_.split(points_);
    planes_.put(pixel, split);
    if (samples.empty()) return;
    ++report_.pixel_count;
    report_.sample_count += samples.size();
    report_.samples_per_px_max =
        std::max(report_.samples_per_px_max, static_cast<uint32_t>(samples.size()));
    report_.merged_pixel_count += split.is_merged;
    report_.error_max_per_m = std::max(report_.error_max_per_m, split.error_per_m);
    error_sum_per_m_ += split.error_per_m;
  }

  DeepExr& file_;
  deep::PixelTidier tidier_;
  deep::PixelSplitter splitter_;
  bool has_black_sky_;
  LayerPlanes planes_;
  std::vector<bool> is_seen_;  // by px; empty without a sky
  std::vector<deep::DeepPoint> points_;
  DeepReport report_;
  double error_sum_per_m_ = 0;
};

LoadedPlane describe(std::vector<uint8_t> bytes, const DeepExr& file, v1::PlaneKind kind) {
  LoadedPlane loaded;
  loaded.plane.set_kind(kind);
  loaded.plane.mutable_size()->set_width(file.widthPx());
  loaded.plane.mutable_size()->set_height(file.heightPx());
  loaded.plane.set_bytes_count(bytes.size());
  loaded.bytes = std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
  return loaded;
}

absl::StatusOr<DeepLayers> layersOf(const v1::DeepFile& options, const DeepExr& file,
                                    DeepSplit& split) {
  DeepLayers layers{.planes = {}, .report = split.report()};
  for (size_t i = 0; i < split.planes().layerCount(); ++i) {
    std::vector<uint8_t> rgba16f = split.planes().takeColor(i);
    v1::ColorPrimaries primaries = options.primaries();
    const std::optional<Imf::Chromaticities> stated = file.chromaticities();
    if (primaries == v1::COLOR_PRIMARIES_UNSPECIFIED && stated) {
      const auto settled = settlePrimaries(options.file(), *stated, rgba16f);
      if (!settled.ok()) return settled.status();
      primaries = *settled;
    }
    LoadedPlane& color =
        layers.planes.emplace_back(describe(std::move(rgba16f), file, v1::PLANE_KIND_COLOR));
    color.plane.set_encoding(v1::PLANE_ENCODING_RGBA16F);
    color.plane.set_transfer(v1::COLOR_TRANSFER_LINEAR);
    color.plane.set_primaries(primaries);
    color.plane.set_alpha(v1::ALPHA_MODE_PREMULTIPLIED);
    LoadedPlane& depth = layers.planes.emplace_back(
        describe(split.planes().takeDepth(i), file, v1::PLANE_KIND_DEPTH));
    depth.plane.set_encoding(v1::PLANE_ENCODING_DEPTH_F32);
    depth.plane.mutable_depth()->set_meaning(options.depth().meaning());
  }
  return layers;
}

}  // namespace

double DeepReport::mergedShare() const {
  if (pixel_count == 0) return 0;
  return static_cast<double>(merged_pixel_count) / static_cast<double>(pixel_count);
}

absl::StatusOr<DeepLayers> loadDeepLayers(const v1::DeepFile& options,
                                          const std::filesystem::path& folder) {
  const uint32_t layer_count_max = options.layers() == 0 ? deep::kGroupsMax : options.layers();
  if (layer_count_max > deep::kGroupsMax) {
    return invalidField("layers", strCat("is ", options.layers(), "; accepted is 1..",
                                         deep::kGroupsMax, ", 0 for the most"));
  }
  VIEWLOOM_RETURN_IF_ERROR(checkDepth(options.depth()));
  const DeepUnits units = {
      .scale = options.depth().scale() == 0 ? 1 : options.depth().scale(),
      .offset_m = options.depth().offset(),
  };
  const std::filesystem::path path = folder / options.file();
  absl::StatusOr<DeepExr> file = DeepExr::open(path, units, exrWindow(options.window()));
  if (!file.ok()) return file.status();
  const uint64_t bytes_max =
      uint64_t{layer_count_max} * file->widthPx() * file->heightPx() * (kColorBytes + kDepthBytes);
  if (bytes_max > kLayersBytesMax) {
    return refuseFile(path.string(), strCat("would take ", bytes_max, " bytes as ", layer_count_max,
                                            " layers; accepted are up to ", kLayersBytesMax));
  }
  DeepSplit split(*file, layer_count_max, options.black_sky());
  VIEWLOOM_RETURN_IF_ERROR(split.run());
  absl::StatusOr<DeepLayers> layers = layersOf(options, *file, split);
  if (layers.ok()) layers->report.file = options.file();
  return layers;
}

}  // namespace viewloom::files
