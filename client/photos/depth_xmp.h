// SPDX-License-Identifier: Apache-2.0
// Description of a photo's depth image in its XMP.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace viewloom::photos {

// Numbers are finite. A property that is absent, or whose value is none, is not there.
struct DepthXmp {
  std::string image_type;  // apdi:AuxiliaryImageType: disparity, depth, or what is no depth
  std::string accuracy;    // depthData:Accuracy: relative or absolute
  // Codes int_min..int_max stand for float_min..float_max, linearly: 1/m of disparity, m of depth.
  std::optional<double> int_min, int_max, float_min, float_max;
};

// Properties may be elements or attributes, under any prefix that is bound to the namespaces
// http://ns.apple.com/pixeldatainfo/1.0/ and http://ns.apple.com/depthData/1.0/.
DepthXmp parseDepthXmp(std::string_view xml);

// Google's depth map of a photo.
struct GoogleDepth {
  std::string format;                   // RangeInverse or RangeLinear
  std::optional<double> near_m, far_m;  // of code 0 and of the largest
  std::string data;                     // base64 of a picture
};

// GDepth of a photo's XMP, whose Data may be in its extended XMP. Nothing without Data.
std::optional<GoogleDepth> parseGoogleDepth(std::string_view xml, std::string_view extended_xml);

}  // namespace viewloom::photos
