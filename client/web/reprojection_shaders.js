// SPDX-License-Identifier: Apache-2.0
// Draws a picture with depth as a surface, seen from elsewhere: a mesh with a vertex in the middle
// of each block of 2 x 2 px, and around the edge.

// Three vertices make a triangle, two triangles a cell between four blocks. No buffers: a vertex
// knows by its number where it lies.
export const kSurfaceVertex = `#version 300 es
precision highp float;
precision highp sampler2D;
uniform sampler2D depth;        // 1/Z of each block, 1/m
uniform ivec2 first_block;      // of the view's tile
uniform ivec2 blocks;           // of the view
uniform vec2 tile_px;
uniform vec2 first_px;          // of the tile in the picture
uniform vec2 picture_px;
uniform mat4 clip_from_source;  // of (u, v, 1, 1/Z)
uniform vec2 target_px;
uniform float stretch_max_px;   // a cell that is torn wider shows a place nobody has seen
uniform float margin_px;        // by which the edge goes on around the picture
out vec2 uv;

const ivec2 kCorners[6] = ivec2[6](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1),
                                   ivec2(0, 1), ivec2(1, 0), ivec2(1, 1));

// On the picture, px.
vec2 placeOf(ivec2 corner) {
  return clamp(vec2(2 * corner - 1), vec2(0), tile_px);
}

vec2 withMargin(ivec2 corner) {
  vec2 outwards = vec2(equal(corner, blocks + 1)) - vec2(equal(corner, ivec2(0)));
  return placeOf(corner) + margin_px * outwards;
}

vec4 seen(ivec2 corner) {
  ivec2 block = clamp(corner - 1, ivec2(0), blocks - 1);
  float inv_z = texelFetch(depth, first_block + block, 0).r;
  return clip_from_source * vec4(withMargin(corner), 1, inv_z);
}

vec2 pxOf(vec4 clip) {
  return 0.5 * target_px * vec2(clip.x, -clip.y) / max(clip.w, 1e-9);
}

void main() {
  int cell = gl_VertexID / 6;
  ivec2 first = ivec2(cell % (blocks.x + 1), cell / (blocks.x + 1));
  ivec2 corner = first + kCorners[gl_VertexID % 6];
  gl_Position = seen(corner);
  uv = (first_px + placeOf(corner)) / picture_px;
  if (stretch_max_px <= 0.0) return;
  vec4 corners[4] = vec4[4](seen(first), seen(first + ivec2(1, 0)), seen(first + ivec2(0, 1)),
                            seen(first + ivec2(1, 1)));
  vec2 low = vec2(1e9), high = vec2(-1e9);
  bool isBehind = false;
  for (int i = 0; i < 4; ++i) {
    vec2 px = pxOf(corners[i]);
    low = min(low, px);
    high = max(high, px);
    isBehind = isBehind || corners[i].w <= 0.0;
  }
  vec2 torn = high - low;
  if (isBehind || max(torn.x, torn.y) > stretch_max_px) gl_Position = vec4(2, 2, 2, 1);
}`;

export const kSurfaceFragment = `#version 300 es
precision highp float;
uniform sampler2D picture;
in vec2 uv;
out vec4 color;
void main() { color = vec4(texture(picture, uv).rgb, 1); }`;
