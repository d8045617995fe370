// SPDX-License-Identifier: Apache-2.0
#include "pictures/svg.h"

#include <charconv>
#include <cmath>

#include "base/str_cat.h"

namespace viewloom::pictures {
namespace {

// Layers are blue and orange, what is unknown red; told apart also by who sees no red or green.
constexpr std::string_view kStyles = R"(
text{font-family:sans-serif;font-size:12px;fill:#333}
.small{font-size:10px}.end{text-anchor:end}.middle{text-anchor:middle}
.paper{fill:#fff}.frame{fill:none;stroke:#333}.grid{stroke:#e4e4e4}.axis{stroke:#333}
.layer0{stroke:#2166ac;stroke-width:3}.layer1{stroke:#e08214;stroke-width:3}
.thin0{stroke:#2166ac}.thin1{stroke:#e08214}
.sample0{fill:#2166ac}.sample1{fill:#e08214}
.run0{stroke:#2166ac;stroke-width:4}.next0{stroke:#67a9cf;stroke-width:4}
.run1{stroke:#e08214;stroke-width:4}.next1{stroke:#fdb863;stroke-width:4}
.link{fill:#fff;stroke:#1a9850;stroke-width:2}.across{fill:#1a9850;stroke:#1a9850;stroke-width:2}
.silhouette{stroke:#d73027;stroke-width:2;stroke-dasharray:3 3}
.bridge{stroke:#1a9850;stroke-width:3}.far{stroke:#d73027;stroke-width:2;stroke-dasharray:7 4}
.ray{stroke:#777}.hit{stroke:#999;stroke-width:1}.assumed{stroke:#1a9850;stroke-width:1.5}
.hidden{stroke:#d73027;stroke-width:1.5}.outside{stroke:#bbb;stroke-dasharray:2 3}
.meets{fill:#333}.plane{stroke:#fff;stroke-width:1.5}.cells{stroke:#d73027;stroke-width:1.5}
.texel{stroke:none}.unknown{fill:#fff;stroke:#d73027}
)";

// Tenths of a px: what is drawn is no finer.
std::string number(double value) {
  const long tenths = std::lround(value * 10);
  const long magnitude = std::labs(tenths);
  return strCat(tenths < 0 ? "-" : "", magnitude / 10, ".", magnitude % 10);
}

std::string attribute(std::string_view name, double value) {
  return strCat(" ", name, "=\"", number(value), "\"");
}

}  // namespace

void Svg::line(Point from, Point to, std::string_view style) {
  shapes_ += strCat("<line class=\"", style, "\"", attribute("x1", from.x), attribute("y1", from.y),
                    attribute("x2", to.x), attribute("y2", to.y), "/>\n");
}

void Svg::circle(Point center, double radius_px, std::string_view style) {
  shapes_ += strCat("<circle class=\"", style, "\"", attribute("cx", center.x),
                    attribute("cy", center.y), attribute("r", radius_px), "/>\n");
}

void Svg::box(Point corner, double box_width_px, double box_height_px, std::string_view style,
              std::string_view fill) {
  const std::string own_fill = fill.empty() ? "" : strCat(" style=\"fill:", fill, "\"");
  shapes_ += strCat("<rect class=\"", style, "\"", own_fill, attribute("x", corner.x),
                    attribute("y", corner.y), attribute("width", box_width_px),
                    attribute("height", box_height_px), "/>\n");
}

void Svg::text(Point at, std::string_view words, std::string_view style) {
  shapes_ += strCat("<text class=\"", style, "\"", attribute("x", at.x), attribute("y", at.y), ">",
                    words, "</text>\n");
}

std::string Svg::file() const {
  return strCat("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 ", width_px_, " ",
                height_px_, "\" width=\"", width_px_, "\" height=\"", height_px_, "\">\n<style>",
                kStyles, "</style>\n<rect class=\"paper\" width=\"", width_px_, "\" height=\"",
                height_px_, "\"/>\n", shapes_, "</svg>\n");
}

namespace {

// Takes the number that a text begins with, if it begins with one.
bool takeNumber(std::string_view& text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return false;
  text.remove_prefix(size_t(end - text.data()));
  return true;
}

}  // namespace

bool showTheSame(std::string_view a, std::string_view b, double tolerance) {
  while (!a.empty() && !b.empty()) {
    double in_a = 0;
    double in_b = 0;
    const bool is_number = takeNumber(a, in_a);
    if (is_number != takeNumber(b, in_b)) return false;
    if (is_number && !(std::abs(in_a - in_b) <= tolerance)) return false;
    if (is_number) continue;
    if (a.front() != b.front()) return false;
    a.remove_prefix(1);
    b.remove_prefix(1);
  }
  return a.empty() && b.empty();
}

}  // namespace viewloom::pictures
