// SPDX-License-Identifier: Apache-2.0
// A quilt woven for a panel: each subpixel shows the view that its lens sends the way it lies.
#include "shared/lenticular.h"

uniform Lenticular lens;
uniform vec2 panel_size_px;
uniform uint window_height_px;
uniform sampler2D atlas;
uniform vec2 atlas_size_px;
uniform vec2 tile_size_px;
uniform float padding_top_px;
uniform uvec2 tile_count;      // columns, rows
uniform uint view_count;
uniform uint is_bottom_left;   // 1: view 0 lies bottom left; 0: top left
uniform uint is_blended;       // 1: neighbouring views are blended; 0: the nearest view
out vec4 shown;

// Colour of a view at uv, from the top left of its picture.
vec3 viewColor(uint view, vec2 uv) {
  uint row = view / tile_count.x;
  if (is_bottom_left != 0u) row = tile_count.y - 1u - row;
  vec2 corner_px = vec2(float(view % tile_count.x), float(row)) * tile_size_px;
  corner_px.y += padding_top_px;
  // Half a px within the tile, or its neighbours' colours come in.
  vec2 at_px = clamp(uv * tile_size_px, vec2(0.5), tile_size_px - 0.5);
  return textureLod(atlas, (corner_px + at_px) / atlas_size_px, 0.0).rgb;
}

vec3 colorAt(float coordinate, vec2 uv) {
  if (is_blended == 0u) return viewColor(nearestView(coordinate, view_count), uv);
  // View i looks from the middle of its share of the cone.
  float position = clamp(coordinate * float(view_count) - 0.5, 0.0, float(view_count - 1u));
  uint lower = min(uint(position), view_count - 1u);
  uint upper = min(lower + 1u, view_count - 1u);
  return mix(viewColor(lower, uv), viewColor(upper, uv), position - float(lower));
}

void main() {
  uint x_px = uint(gl_FragCoord.x);
  uint y_px = window_height_px - 1u - uint(gl_FragCoord.y);
  shown = vec4(0.0, 0.0, 0.0, 1.0);
  if (float(x_px) >= panel_size_px.x || float(y_px) >= panel_size_px.y) return;
  vec2 uv = (vec2(float(x_px), float(y_px)) + 0.5) / panel_size_px;
  shown.r = colorAt(viewCoordinate(lens, x_px, y_px, 0u), uv).r;
  shown.g = colorAt(viewCoordinate(lens, x_px, y_px, 1u), uv).g;
  shown.b = colorAt(viewCoordinate(lens, x_px, y_px, 2u), uv).b;
}
