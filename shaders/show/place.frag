// SPDX-License-Identifier: Apache-2.0
// A part of a picture in a part of the window; px by px where both are of one size.

uniform sampler2D picture;
uniform vec2 picture_size_px;
uniform vec4 source_px;  // left, top, width, height in the picture
uniform vec4 target_px;  // the same in the window
uniform float window_height_px;
out vec4 shown;

void main() {
  vec2 in_window_px = vec2(gl_FragCoord.x, window_height_px - gl_FragCoord.y);
  vec2 in_target_px = in_window_px - target_px.xy;
  if (source_px.zw == target_px.zw) {
    shown = texelFetch(picture, ivec2(floor(source_px.xy + in_target_px)), 0);
    return;
  }
  vec2 in_source_px = in_target_px * source_px.zw / target_px.zw;
  in_source_px = clamp(in_source_px, vec2(0.5), source_px.zw - 0.5);
  shown = textureLod(picture, (source_px.xy + in_source_px) / picture_size_px, 0.0);
}
