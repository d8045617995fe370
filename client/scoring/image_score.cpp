// SPDX-License-Identifier: Apache-2.0
#include "scoring/image_score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "base/check.h"
#include "scoring/flip.h"
#include "scoring/psnr.h"

namespace viewloom {
namespace {

constexpr int kWindowRadius_px = 5;
constexpr double kWindowSigma_px = 1.5;
constexpr double kStabiliserMean = 0.01 * 0.01;      // (K1 L)^2 with peak L = 1
constexpr double kStabiliserContrast = 0.03 * 0.03;  // (K2 L)^2

using Values = std::vector<double>;  // [pixel]

std::array<double, 2 * kWindowRadius_px + 1> windowWeights() {
  std::array<double, 2 * kWindowRadius_px + 1> weights{};
  double* const weight_at = &weights[kWindowRadius_px];
  for (int i = -kWindowRadius_px; i <= kWindowRadius_px; ++i) {
    weight_at[i] = std::exp(-i * i / (2 * kWindowSigma_px * kWindowSigma_px));
  }
  return weights;
}

// The weighted mean of the samples `step` apart around each of `count` samples.
void blurLine(const double* from, double* to, int count, size_t step) {
  static const auto weights = windowWeights();
  const double* const weight_at = &weights[kWindowRadius_px];  // [distance, negative too]
  for (int i = 0; i < count; ++i) {
    double sum = 0;
    double weight_sum = 0;
    const int last = std::min(i + kWindowRadius_px, count - 1);
    for (int j = std::max(i - kWindowRadius_px, 0); j <= last; ++j) {
      const double weight = weight_at[j - i];
      sum += weight * from[size_t(j) * step];
      weight_sum += weight;
    }
    to[size_t(i) * step] = sum / weight_sum;
  }
}

Values blurred(const Values& plane, SizePx size_px) {
  Values rows(plane.size());
  for (size_t y = 0; y < size_px.height; ++y) {
    const size_t begin = y * size_px.width;
    blurLine(&plane[begin], &rows[begin], int(size_px.width), 1);
  }
  Values both(plane.size());
  for (size_t x = 0; x < size_px.width; ++x) {
    blurLine(&rows[x], &both[x], int(size_px.height), size_px.width);
  }
  return both;
}

Values lumaOf(const ScoredImage& image) {
  Values luma(image.size_px.area());
  for (size_t i = 0; i < luma.size(); ++i) {
    const float* rgb = &image.rgb[3 * i];
    luma[i] = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
  }
  return luma;
}

Values product(const Values& a, const Values& b) {
  Values products(a.size());
  std::transform(a.begin(), a.end(), b.begin(), products.begin(), std::multiplies<>());
  return products;
}

Values ssimMap(const Values& a, const Values& b, SizePx size_px) {
  const Values mean_a = blurred(a, size_px);
  const Values mean_b = blurred(b, size_px);
  const Values mean_aa = blurred(product(a, a), size_px);
  const Values mean_bb = blurred(product(b, b), size_px);
  const Values mean_ab = blurred(product(a, b), size_px);
  Values map(a.size());
  for (size_t i = 0; i < map.size(); ++i) {
    const double variance_a = mean_aa[i] - mean_a[i] * mean_a[i];
    const double variance_b = mean_bb[i] - mean_b[i] * mean_b[i];
    const double covariance = mean_ab[i] - mean_a[i] * mean_b[i];
    map[i] = (2 * mean_a[i] * mean_b[i] + kStabiliserMean) *
             (2 * covariance + kStabiliserContrast) /
             ((mean_a[i] * mean_a[i] + mean_b[i] * mean_b[i] + kStabiliserMean) *
              (variance_a + variance_b + kStabiliserContrast));
  }
  return map;
}

std::vector<float> lightOf(const ScoredImage& image, ScoreTransfer transfer) {
  std::vector<float> light(image.rgb.size());
  std::transform(image.rgb.begin(), image.rgb.end(), light.begin(), [transfer](float scored) {
    return static_cast<float>(linearFromScored(std::clamp(scored, 0.0F, 1.0F), transfer));
  });
  return light;
}

}  // namespace

ImageComparison::ImageComparison(const ScoredImage& got, const ScoredImage& truth,
                                 ScoreTransfer transfer)
    : size_px_(got.size_px), squared_error_(got.size_px.area()) {
  VIEWLOOM_CHECK(got.size_px == truth.size_px && size_px_.area() > 0);
  VIEWLOOM_CHECK(got.rgb.size() == 3 * size_px_.area() && truth.rgb.size() == got.rgb.size());
  for (size_t i = 0; i < squared_error_.size(); ++i) {
    for (size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const double difference = double(got.rgb[c]) - double(truth.rgb[c]);
      squared_error_[i] += difference * difference / 3;
    }
  }
  ssim_ = ssimMap(lumaOf(got), lumaOf(truth), size_px_);
  flip_ = flipMap(lightOf(got, transfer), lightOf(truth, transfer), size_px_);
}

ImageScore ImageComparison::score(std::span<const uint8_t> selected,
                                  uint64_t considered_count) const {
  VIEWLOOM_CHECK(selected.size() == squared_error_.size());
  ImageScore result;
  double error_sum = 0;
  double ssim_sum = 0;
  double flip_sum = 0;
  for (size_t i = 0; i < selected.size(); ++i) {
    if (selected[i] == 0) continue;
    ++result.pixel_count;
    error_sum += squared_error_[i];
    ssim_sum += ssim_[i];
    flip_sum += flip_[i];
  }
  const auto count = static_cast<double>(result.pixel_count);
  result.share = considered_count == 0 ? 0 : count / static_cast<double>(considered_count);
  result.psnr_db = psnrDb(error_sum / count);
  result.ssim = ssim_sum / count;
  result.flip = flip_sum / count;
  return result;
}

ClassScores scoreByClass(const ImageComparison& comparison, std::span<const PixelClass> classes) {
  std::vector<uint8_t> selected(classes.size());
  const auto score = [&](auto is_selected) {
    std::transform(classes.begin(), classes.end(), selected.begin(), is_selected);
    return comparison.score(selected, classes.size());
  };
  const auto of_class = [&](PixelClass wanted) {
    return score([wanted](PixelClass given) { return given == wanted; });
  };
  return {.covered = of_class(PixelClass::kCovered),
          .hidden = of_class(PixelClass::kHidden),
          .outside = of_class(PixelClass::kOutside),
          .all = score([](PixelClass) { return true; })};
}

}  // namespace viewloom
