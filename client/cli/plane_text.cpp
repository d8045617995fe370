// SPDX-License-Identifier: Apache-2.0
#include "cli/plane_text.h"

#include <algorithm>
#include <cctype>

#include "base/str_cat.h"

namespace viewloom::cli {
namespace {

// The rest of an enum's name, in small letters: "PLANE_ENCODING_DEPTH_F32" gives "depth_f32".
std::string wordOf(const std::string& name, const std::string& prefix) {
  std::string word = name.substr(std::min(prefix.size(), name.size()));
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word;
}

}  // namespace

std::string sizeText(const v1::SizePx& size) {
  return strCat(size.width(), "x", size.height());
}

std::string encodingOf(const v1::Plane& plane) {
  return wordOf(v1::PlaneEncoding_Name(plane.encoding()), "PLANE_ENCODING_");
}

std::string sampleText(const v1::Plane& plane) {
  switch (plane.encoding()) {
    case v1::PLANE_ENCODING_RGB8:
      return "RGB of 8 bits";
    case v1::PLANE_ENCODING_RGBA8:
      return "RGBA of 8 bits";
    case v1::PLANE_ENCODING_RGBA16F:
      return "RGBA, floats of 16 bits";
    case v1::PLANE_ENCODING_JPEG:
      return "JPEG";
    case v1::PLANE_ENCODING_H264:
      return "H.264";
    case v1::PLANE_ENCODING_DEPTH_F16:
      return "floats of 16 bits";
    case v1::PLANE_ENCODING_DEPTH_F32:
      return "floats of 32 bits";
    case v1::PLANE_ENCODING_DEPTH_U16:
      return "whole numbers of 16 bits";
    default:
      return encodingOf(plane);
  }
}
std::string transferOf(const v1::Plane& plane) {
  return wordOf(v1::ColorTransfer_Name(plane.transfer()), "COLOR_TRANSFER_");
}
std::string primariesOf(const v1::Plane& plane) {
  return wordOf(v1::ColorPrimaries_Name(plane.primaries()), "COLOR_PRIMARIES_");
}
std::string alphaOf(const v1::Plane& plane) {
  return wordOf(v1::AlphaMode_Name(plane.alpha()), "ALPHA_MODE_");
}
std::string meaningOf(const v1::Plane& plane) {
  return wordOf(v1::DepthMeaning_Name(plane.depth().meaning()), "DEPTH_MEANING_");
}

double scaleOf(const v1::DepthFormat& format) {
  return format.scale() == 0 ? 1 : format.scale();
}

// For example "metres along the view axis = sample x 0.001 + 0; 0 is no surface".
std::string depthText(const v1::Plane& plane) {
  const v1::DepthFormat& format = plane.depth();
  std::string text;
  if (format.meaning() == v1::DEPTH_MEANING_WINDOW) {
    text = strCat("window depth ", format.min_depth(), "..",
                  format.max_depth() == 0 ? 1 : format.max_depth(), ", near ", format.near_z_m(),
                  " m, far ", format.far_z_m(), " m",
                  format.near_z_m() > format.far_z_m() ? ", reversed" : "");
  } else {
    const char* const what = format.meaning() == v1::DEPTH_MEANING_DISPARITY ? "1/Z in 1/m"
                             : format.meaning() == v1::DEPTH_MEANING_RAY_DISTANCE
                                 ? "metres from the eye"
                                 : "metres along the view axis";
    text = strCat(what, " = sample x ", scaleOf(format), " + ", format.offset());
  }
  if (!format.has_invalid_value()) return text;
  return strCat(text, "; ", format.invalid_value(),
                format.invalid_is_far() ? " is infinitely far" : " is no surface");
}

}  // namespace viewloom::cli
