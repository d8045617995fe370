// SPDX-License-Identifier: Apache-2.0
// Shader text for views that lie in the pictures of a video (proto VideoStack).

// Moves the views of one picture from their cells to their tiles: two triangles a cell. Rows of px
// count from the top.
export const kCellsVertex = `#version 300 es
uniform uint picture, picture_count, cell_columns;
uniform uint tile_columns, tile_rows, padding_top_px, is_bottom_left;
uniform uvec2 cell_px, tile_px;
uniform vec2 target_px;
flat out ivec2 origin_px;  // of the view in the picture
out vec2 at_px;            // from there

void main() {
  uint cell = uint(gl_InstanceID);
  uint view = picture + cell * picture_count;
  uint row = view / tile_columns;
  uint row_from_top = is_bottom_left != 0u ? tile_rows - 1u - row : row;
  vec2 tile_origin_px = vec2(view % tile_columns * tile_px.x,
                             padding_top_px + row_from_top * tile_px.y);
  origin_px = ivec2(cell % cell_columns * cell_px.x, cell / cell_columns * cell_px.y);
  bool is_right = gl_VertexID == 1 || gl_VertexID == 2 || gl_VertexID == 4;
  bool is_low = gl_VertexID == 2 || gl_VertexID == 4 || gl_VertexID == 5;
  at_px = vec2(is_right ? tile_px.x : 0u, is_low ? tile_px.y : 0u);
  vec2 place = (tile_origin_px + at_px) / target_px;
  gl_Position = vec4(2.0 * place.x - 1.0, 1.0 - 2.0 * place.y, 0, 1);
}`;

export const kCellsFragment = `#version 300 es
precision highp float;
precision highp int;
uniform sampler2D picture_rgb;
flat in ivec2 origin_px;
in vec2 at_px;
out vec4 color;

void main() {
  color = vec4(texelFetch(picture_rgb, origin_px + ivec2(at_px), 0).rgb, 1);
}`;

// Lookup in the planes of all pictures, a layer each. Y, Cb and Cr have full range and the weights
// of BT.601, as in JPEG files. Filters stay inside of the view: its neighbours are other views.
export const kStackLookup = `
precision highp sampler2DArray;
uniform sampler2DArray luma, cb, cr;
uniform uint stack_count, cell_columns;
uniform uvec2 cell_px, view_px;

vec3 viewOrigin(uint view) {
  uint cell = view / stack_count;
  return vec3(cell % cell_columns * cell_px.x, cell / cell_columns * cell_px.y,
              view % stack_count);
}

// origin: of viewOrigin(). at_px: from the view's left and top.
float viewLuma(vec3 origin, vec2 at_px) {
  vec2 inside_px = clamp(at_px, vec2(0.5), vec2(view_px) - 0.5);
  return texture(luma, vec3((origin.xy + inside_px) / vec2(textureSize(luma, 0).xy), origin.z)).r;
}

// Place in the textures of chroma.
vec3 chromaPlace(vec3 origin, vec2 at_px) {
  vec2 chroma_px = vec2((view_px + 1u) / 2u);
  vec2 place_px = 0.5 * origin.xy + clamp(0.5 * at_px, vec2(0.5), chroma_px - 0.5);
  return vec3(place_px / vec2(textureSize(cb, 0).xy), origin.z);
}

float cbAt(vec3 place) { return texture(cb, place).r - 128.0 / 255.0; }
float crAt(vec3 place) { return texture(cr, place).r - 128.0 / 255.0; }

// One channel of a view; each reads only the planes that it takes.
float viewChannel(uint view, vec2 at_px, uint channel) {
  vec3 origin = viewOrigin(view);
  vec3 place = chromaPlace(origin, at_px);
  float level = viewLuma(origin, at_px);
  if (channel == 0u) level += 1.402 * crAt(place);
  else if (channel == 1u) level -= 0.344136 * cbAt(place) + 0.714136 * crAt(place);
  else level += 1.772 * cbAt(place);
  return clamp(level, 0.0, 1.0);
}
`;
