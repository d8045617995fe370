// SPDX-License-Identifier: Apache-2.0
#include "scoring/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "scoring/separable_filter.h"

namespace viewloom {
namespace {

using Plane = std::vector<float>;
using Vec3 = std::array<float, 3>;
using Planes = std::array<Plane, 3>;

// Contrast sensitivity of one channel as a sum of two Gaussians over the distance x in degrees,
// a sqrt(pi / b) exp(-pi^2 x^2 / b) each (section 4.1.1, table 1).
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity kAchromatic = {1, 0.0047, 0, 1};
constexpr Sensitivity kRedGreen = {1, 0.0053, 0, 1};
constexpr Sensitivity kBlueYellow = {34.1, 0.04, 13.5, 0.025};
constexpr double kWidest = 0.04;  // the b of the widest Gaussian: it sets the radius of all

constexpr double kColorExponent = 0.7;    // q_c
constexpr double kColorKnee = 0.4;        // p_c, share of the largest colour difference
constexpr double kErrorAtKnee = 0.95;     // p_t
constexpr double kFeatureExponent = 0.5;  // q_f
constexpr double kFeatureWidth_deg = 0.082;

// Linear BT.709 to XYZ (IEC 61966-2-1) and back.
constexpr std::array<Vec3, 3> kXyzFromRgb = {Vec3{0.4124564F, 0.3575761F, 0.1804375F},
                                             Vec3{0.2126729F, 0.7151522F, 0.0721750F},
                                             Vec3{0.0193339F, 0.1191920F, 0.9503041F}};
constexpr std::array<Vec3, 3> kRgbFromXyz = {Vec3{3.2404542F, -1.5371385F, -0.4985314F},
                                             Vec3{-0.9692660F, 1.8760108F, 0.0415560F},
                                             Vec3{0.0556434F, -0.2040259F, 1.0572252F}};

Vec3 times(const std::array<Vec3, 3>& matrix, const Vec3& v) {
  Vec3 product{};
  for (size_t i = 0; i < 3; ++i) {
    product[i] = matrix[i][0] * v[0] + matrix[i][1] * v[1] + matrix[i][2] * v[2];
  }
  return product;
}

// XYZ relative to white.
Vec3 whiteXyz() {
  static const Vec3 white = times(kXyzFromRgb, {1, 1, 1});
  return white;
}
Vec3 relativeXyz(const Vec3& rgb) {
  Vec3 xyz = times(kXyzFromRgb, rgb);
  for (size_t i = 0; i < 3; ++i) xyz[i] /= whiteXyz()[i];
  return xyz;
}

// The linear opponent space Y Cx Cz.
Vec3 opponentOf(const Vec3& rgb) {
  const Vec3 xyz = relativeXyz(rgb);
  return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}
Vec3 rgbOfOpponent(const Vec3& opponent) {
  const float y = (opponent[0] + 16) / 116;
  Vec3 xyz = {y + opponent[1] / 500, y, y - opponent[2] / 200};
  for (size_t i = 0; i < 3; ++i) xyz[i] *= whiteXyz()[i];
  Vec3 rgb = times(kRgbFromXyz, xyz);
  for (float& channel : rgb) channel = std::clamp(channel, 0.0F, 1.0F);
  return rgb;
}

// CIELAB with chroma that fades with lightness, as Hunt found (section 4.1.2).
Vec3 huntLabOf(const Vec3& rgb) {
  constexpr float kDelta = 6.0F / 29;
  Vec3 f = relativeXyz(rgb);
  for (float& t : f) {
    t = t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0F / 29;
  }
  const float lightness = 116 * f[1] - 16;
  return {lightness, 0.01F * lightness * 500 * (f[0] - f[1]),
          0.01F * lightness * 200 * (f[1] - f[2])};
}

double hyAb(const Vec3& a, const Vec3& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

// exp(-x^2 / (2 sigma^2)) at whole x up to `radius` on both sides.
Plane gaussian(double sigma, int radius) {
  Plane weights;
  for (int x = -radius; x <= radius; ++x) {
    weights.push_back(static_cast<float>(std::exp(-x * x / (2 * sigma * sigma))));
  }
  return weights;
}

// Scales weights so that the positive ones sum to 1 and the negative ones to -1, if there are.
Plane balanced(Plane weights) {
  double above = 0;
  double below = 0;
  for (const float w : weights) (w > 0 ? above : below) += std::abs(w);
  for (float& w : weights) w = static_cast<float>(w / (w > 0 ? above : below));
  return weights;
}

Plane seen(const Plane& plane, SizePx size_px, const Sensitivity& channel, double px_per_degree) {
  const auto sigma_px = [&](double b) {
    return std::sqrt(b / 2) / std::numbers::pi * px_per_degree;
  };
  const int radius = static_cast<int>(std::ceil(3 * sigma_px(kWidest)));
  Plane sum(plane.size(), 0.0F);
  double weight_sum = 0;
  for (const auto& [a, b] : {std::pair{channel.a1, channel.b1}, {channel.a2, channel.b2}}) {
    if (a == 0) continue;
    const Plane bell = gaussian(sigma_px(b), radius);
    double bell_sum = 0;
    for (const float w : bell) bell_sum += w;
    const double weight = a * std::sqrt(std::numbers::pi / b) * bell_sum * bell_sum;
    const Plane blurred = filtered(plane, size_px, balanced(bell), balanced(bell));
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += static_cast<float>(weight) * blurred[i];
    weight_sum += weight;
  }
  for (float& value : sum) value /= static_cast<float>(weight_sum);
  return sum;
}

Planes opponentPlanes(std::span<const float> rgb, SizePx size_px) {
  Planes planes;
  for (Plane& plane : planes) plane.resize(size_px.area());
  for (size_t i = 0; i < size_px.area(); ++i) {
    const float* px = &rgb[3 * i];
    const Vec3 opponent = opponentOf({std::clamp(px[0], 0.0F, 1.0F), std::clamp(px[1], 0.0F, 1.0F),
                                      std::clamp(px[2], 0.0F, 1.0F)});
    for (size_t c = 0; c < 3; ++c) planes[c][i] = opponent[c];
  }
  return planes;
}

// Section 4.1: what is left of the colours at the viewer's distance, as Hunt-adjusted CIELAB.
std::vector<Vec3> perceivedColors(const Planes& opponent, SizePx size_px, double px_per_degree) {
  const Planes channels = {seen(opponent[0], size_px, kAchromatic, px_per_degree),
                           seen(opponent[1], size_px, kRedGreen, px_per_degree),
                           seen(opponent[2], size_px, kBlueYellow, px_per_degree)};
  std::vector<Vec3> colors(size_px.area());
  for (size_t i = 0; i < colors.size(); ++i) {
    colors[i] = huntLabOf(rgbOfOpponent({channels[0][i], channels[1][i], channels[2][i]}));
  }
  return colors;
}

// Section 4.1.3: the largest colour difference becomes 1, and most of the range goes to small ones.
double colorError(const Vec3& got, const Vec3& truth) {
  static const double largest =
      std::pow(hyAb(huntLabOf({0, 1, 0}), huntLabOf({0, 0, 1})), kColorExponent);
  const double knee = kColorKnee * largest;
  const double difference = std::pow(hyAb(got, truth), kColorExponent);
  if (difference < knee) return kErrorAtKnee * difference / knee;
  return kErrorAtKnee + (1 - kErrorAtKnee) * (difference - knee) / (largest - knee);
}

// Section 4.2: how much of an edge and of a point each pixel is.
struct Features {
  Plane edge;
  Plane point;
};

Plane lengths(const Plane& x, const Plane& y) {
  Plane length(x.size());
  for (size_t i = 0; i < length.size(); ++i) length[i] = std::hypot(x[i], y[i]);
  return length;
}

Features featuresOf(const Plane& achromatic, SizePx size_px, double px_per_degree) {
  const double sigma_px = 0.5 * kFeatureWidth_deg * px_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sigma_px));
  Plane lightness(achromatic.size());
  std::transform(achromatic.begin(), achromatic.end(), lightness.begin(),
                 [](float y) { return (y + 16) / 116; });
  const Plane bell = gaussian(sigma_px, radius);
  Plane slope = bell;
  Plane bend = bell;
  for (size_t i = 0; i < bell.size(); ++i) {
    const double x = static_cast<double>(i) - radius;
    slope[i] *= static_cast<float>(-x);
    bend[i] *= static_cast<float>(x * x / (sigma_px * sigma_px) - 1);
  }
  const auto magnitude = [&](const Plane& derivative) {
    return lengths(filtered(lightness, size_px, balanced(derivative), balanced(bell)),
                   filtered(lightness, size_px, balanced(bell), balanced(derivative)));
  };
  return {.edge = magnitude(slope), .point = magnitude(bend)};
}

}  // namespace

std::vector<float> flipMap(std::span<const float> got, std::span<const float> truth, SizePx size_px,
                           double px_per_degree) {
  VIEWLOOM_CHECK(got.size() == 3 * size_px.area() && truth.size() == got.size());
  const Planes got_planes = opponentPlanes(got, size_px);
  const Planes true_planes = opponentPlanes(truth, size_px);
  const std::vector<Vec3> got_colors = perceivedColors(got_planes, size_px, px_per_degree);
  const std::vector<Vec3> true_colors = perceivedColors(true_planes, size_px, px_per_degree);
  const Features got_features = featuresOf(got_planes[0], size_px, px_per_degree);
  const Features true_features = featuresOf(true_planes[0], size_px, px_per_degree);
  std::vector<float> map(size_px.area());
  for (size_t i = 0; i < map.size(); ++i) {
    const double edge = std::abs(got_features.edge[i] - true_features.edge[i]);
    const double point = std::abs(got_features.point[i] - true_features.point[i]);
    const double feature_error =
        std::pow(std::max(edge, point) / std::numbers::sqrt2, kFeatureExponent);
    map[i] =
        static_cast<float>(std::pow(colorError(got_colors[i], true_colors[i]), 1 - feature_error));
  }
  return map;
}

}  // namespace viewloom
