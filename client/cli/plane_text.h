// SPDX-License-Identifier: Apache-2.0
// Descriptions of planes, for people and for machines.
#pragma once

#include <string>

#include "viewloom/v1/frame.pb.h"

namespace viewloom::cli {

std::string sizeText(const v1::SizePx& size);
// "RGB of 8 bits".
std::string sampleText(const v1::Plane& plane);
// Words for machines: "depth_f32", "linear", "bt709", "premultiplied", "planar".
std::string encodingOf(const v1::Plane& plane);
std::string transferOf(const v1::Plane& plane);
std::string primariesOf(const v1::Plane& plane);
std::string alphaOf(const v1::Plane& plane);
std::string meaningOf(const v1::Plane& plane);

double scaleOf(const v1::DepthFormat& format);
// "metres along the view axis = sample x 0.001 + 0; 0 is no surface".
std::string depthText(const v1::Plane& plane);

}  // namespace viewloom::cli
