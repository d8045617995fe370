// SPDX-License-Identifier: Apache-2.0
// A test pattern without a picture: the views left of the middle are blue, those right of it red,
// the middle ones white. Where the lenses are described as they are, an eye in front of the panel
// sees all of it in one colour.
#include "shared/lenticular.h"

uniform Lenticular lens;
uniform vec2 panel_size_px;
uniform uint window_height_px;
out vec4 shown;

const float kHalfWidthOfWhite = 0.0625;  // share of the cone

vec3 patternColor(float coordinate) {
  if (abs(coordinate - 0.5) < kHalfWidthOfWhite) return vec3(1.0);
  return coordinate < 0.5 ? vec3(0.0, 0.2, 1.0) : vec3(1.0, 0.2, 0.0);
}

void main() {
  uint x_px = uint(gl_FragCoord.x);
  uint y_px = window_height_px - 1u - uint(gl_FragCoord.y);
  shown = vec4(0.0, 0.0, 0.0, 1.0);
  if (float(x_px) >= panel_size_px.x || float(y_px) >= panel_size_px.y) return;
  shown.r = patternColor(viewCoordinate(lens, x_px, y_px, 0u)).r;
  shown.g = patternColor(viewCoordinate(lens, x_px, y_px, 1u)).g;
  shown.b = patternColor(viewCoordinate(lens, x_px, y_px, 2u)).b;
}
