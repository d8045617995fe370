// SPDX-License-Identifier: Apache-2.0
// Colours the apron of a face of a cube map as its neighbours would be seen there: between two
// samples along the edge, where they are linked. An invocation a px.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/structure/cube_apron.glsl"
#include "lib/light/srgb.glsl"
#include "lib/structure/structure_access.glsl"

layout(local_size_x = kNodeGroupSize) in;
layout(push_constant, scalar) uniform Push {
  ApronPush push;
};

// Opaque colour takes one uint a px, or two.
uvec2 loadTexel(Address color, int index) {
  if (push.color_format == kColorRgba8) return uvec2(UintRef(color).at[index], 0u);
  return Uvec2Ref(color).at[index];
}

void storeTexel(Address color, int index, uvec2 texel) {
  if (push.color_format == kColorRgba8)
    UintRef(color).at[index] = texel.x;
  else
    Uvec2Ref(color).at[index] = texel;
}

vec3 blendable(uvec2 texel) {
  return push.color_format == kColorRgba8 ? codesOfRgba8(texel.x) : rootsOfRgb16(texel);
}

uvec2 packed(vec3 color) {
  return push.color_format == kColorRgba8 ? uvec2(packCodes(color), 0u) : rgb16FromRoots(color);
}

void main() {
  CubeRef cube = CubeRef(push.cube);
  const int side = int(cube.list.side_px);
  ivec2 pixel;
  if (!apronPixel(gl_GlobalInvocationID.x, side, pixel)) return;
  const FacePlace place = placeOf(cube, push.face, pixel);
  const Extent extent = makeExtent(ivec2(side + 2 * int(kCubeApron_px)));
  const ivec2 cell = place.sample_px + int(kCubeApron_px);
  const int own = cell.y * extent.size_px.x + cell.x;
  // The other of the two samples.
  const float offset = place.is_along_x ? place.offset_px.x : place.offset_px.y;
  const int toward = offset < 0.0 ? -1 : 1;
  const int other = (place.is_along_x ? place.sample_px.x : place.sample_px.y) + toward;
  const uint low_edge = place.is_along_x ? kEdgeLeft : kEdgeTop;
  const uint edge = low_edge + (toward > 0 ? 1u : 0u);
  const int other_texel = own + toward * (place.is_along_x ? 1 : extent.size_px.x);
  for (uint layer = 0u; layer < cube.list.layer_count; ++layer) {
    uvec2 texel = loadTexel(cube.list.faces[place.face].color[layer], own);
    const uint links = loadLinks(cube.list.faces[place.face].layers, layer, extent, cell);
    const uint link = linkOfEdge(links, edge);
    if (link > 0u && other >= 0 && other < side) {
      const Address linked = cube.list.faces[place.face].color[link - 1u];
      texel = packed(
          mix(blendable(texel), blendable(loadTexel(linked, other_texel)), abs(offset)));
    }
    storeTexel(cube.list.faces[push.face].color[layer],
               pixel.y * extent.size_px.x + pixel.x, texel);
  }
}
