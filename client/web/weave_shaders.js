// SPDX-License-Identifier: Apache-2.0
// The fragment shaders of the woven panel, around the text that the server's own shaders include.
import {kStackLookup} from './video_shaders.js';

const kShared = ['gpu_types.h', 'lenticular.h'];

// Colour of a view in a quilt. at: 0..1 from the view's left and top. Half a px inside its tile,
// filters reach no neighbour.
const kQuiltLevel = `
uniform sampler2D quilt;
uniform uvec2 tile_px;
uniform uint columns, rows, padding_top_px, is_bottom_left;

float viewLevel(uint view, vec2 at, uint channel) {
  uint row = view / columns;
  uint row_from_top = is_bottom_left != 0u ? rows - 1u - row : row;
  vec2 origin_px = vec2(view % columns * tile_px.x, padding_top_px + row_from_top * tile_px.y);
  vec2 inside_px = clamp(at * vec2(tile_px), vec2(0.5), vec2(tile_px) - 0.5);
  return texture(quilt, (origin_px + inside_px) / vec2(textureSize(quilt, 0)))[channel];
}
`;

// The same of a view in the pictures of a video.
const kStackLevel = `${kStackLookup}
float viewLevel(uint view, vec2 at, uint channel) {
  return viewChannel(view, at * vec2(view_px), channel);
}
`;

// Which view each subpixel shows, and its colour there.
const kWeave = `
uniform Lenticular lens;
uniform uvec2 panel_px;
uniform uint view_count, target_height_px;
out vec4 color;

void main() {
  uvec2 px = uvec2(gl_FragCoord.x, float(target_height_px) - gl_FragCoord.y);
  color = vec4(0, 0, 0, 1);
  if (any(greaterThanEqual(px, panel_px))) return;
  vec2 at = (vec2(px) + 0.5) / vec2(panel_px);
  vec3 levels;
  for (uint channel = 0u; channel < kCellChannels; ++channel) {
    uint view = nearestView(viewCoordinate(lens, px.x, px.y, channel), view_count);
    levels[channel] = viewLevel(view, at, channel);
  }
  color.rgb = levels;
}`;

// Light that an eye sees of a woven panel: within a lens's width, the subpixels that are sent its
// way. eye: the view coordinate that goes to it from the panel's middle, and how it changes per px
// to the right. blur: standard deviation of the lens, in view coordinates.
const kEye = `
const int kReachMax_px = 24;
uniform sampler2D panel;
uniform Lenticular lens;
uniform uvec2 panel_px;
uniform vec2 eye, target_px;
uniform float blur, lens_width_px, panel_px_per_px;
uniform uint is_bare;
out vec4 color;

vec3 seen(vec2 at_px) {
  int reach_px = min(int(ceil(0.5 * lens_width_px)), kReachMax_px);
  float wanted = eye.x + eye.y * (at_px.x - 0.5 * float(panel_px.x));
  vec3 sum = vec3(0), weights = vec3(0);
  for (int y = -2; y <= 2; ++y) {
    for (int x = -reach_px; x <= reach_px; ++x) {
      ivec2 px = ivec2(floor(at_px)) + ivec2(x, y);
      if (any(lessThan(px, ivec2(0))) || any(greaterThanEqual(px, ivec2(panel_px)))) continue;
      vec3 level = texelFetch(panel, ivec2(px.x, int(panel_px.y) - 1 - px.y), 0).rgb;
      for (uint channel = 0u; channel < kCellChannels; ++channel) {
        float off = viewCoordinate(lens, uint(px.x), uint(px.y), channel) - wanted;
        off = fract(off + 0.5) - 0.5;  // the pattern comes again beside the cone
        float weight = exp(-0.5 * off * off / (blur * blur)) + 1e-12;
        sum[channel] += weight * level[channel];
        weights[channel] += weight;
      }
    }
  }
  return sum / weights;
}

void main() {
  vec2 from_middle_px = vec2(gl_FragCoord.x, target_px.y - gl_FragCoord.y) - 0.5 * target_px;
  vec2 at_px = from_middle_px * panel_px_per_px + 0.5 * vec2(panel_px);
  color = vec4(0.039, 0.047, 0.063, 1);  // the ground of the page
  if (any(lessThan(at_px, vec2(0))) || any(greaterThanEqual(at_px, vec2(panel_px)))) return;
  ivec2 px = ivec2(at_px.x, float(panel_px.y) - at_px.y);
  color.rgb = is_bare != 0u ? texelFetch(panel, px, 0).rgb : seen(at_px);
}`;

async function fetchText(path) {
  const reply = await fetch(path);
  if (!reply.ok) throw new Error(`the server gave no ${path}: ${reply.status}`);
  return reply.text();
}

// Fragment shaders, complete: {weave, weaveStack, eye}. The second one takes planes of a video.
export async function fetchShaders() {
  const texts = await Promise.all(kShared.map(fetchText));
  const shared = texts.join('\n').replace(/^#include "shared\/.*$/gm, '');
  const head = `#version 300 es\nprecision highp float;\nprecision highp int;\n${shared}`;
  return {
    weave: head + kQuiltLevel + kWeave, weaveStack: head + kStackLevel + kWeave, eye: head + kEye,
  };
}
