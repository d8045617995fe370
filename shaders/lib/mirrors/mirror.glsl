// SPDX-License-Identifier: Apache-2.0
// How a surface mirrors where a ray met it, and the rays it sends on. Metres are those of a
// source's camera: x to the right, y down, z along its axis.
#ifndef VIEWLOOM_LIB_MIRRORS_MIRROR_GLSL_
#define VIEWLOOM_LIB_MIRRORS_MIRROR_GLSL_

#include "lib/light/color.glsl"
#include "lib/walk/face_ray.glsl"
#include "lib/rays/ray.glsl"
#include "lib/walk/ray_answer.glsl"
#include "lib/walk/walk.glsl"
#include "shared/reflection_abi.h"

layout(set = 0, binding = kBindingSurface) uniform usamplerBuffer surface_texels;

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SurfaceRef {
  SurfaceTexel at[];
};

// Rays begin behind the layers in front of their surface, and know no other side of surfaces.
const WalkRules kMeetsReflections = WalkRules(true, true);

// A place on a surface.
struct Spot {
  vec3 point;  // x px, y px, inv_z
  ivec2 cell;
  uint layer;
};

struct Mirror {
  vec3 normal;        // unit length, towards the source's camera
  vec3 facet_normal;  // of the surface itself
  vec3 light;         // what it mirrors head on, 0..1
  float roughness;
};

SurfaceTexel loadSurface(Address surfaces[kLayerCountMax], uint layer, uint count, uint index) {
  if (kReadByAddress) return SurfaceRef(pickAddress(surfaces, layer)).at[index];
  const uvec2 bits = texelFetch(surface_texels, int(layer * count + index)).xy;
  return SurfaceTexel(bits.x, bits.y);
}

// Normal from SurfaceTexel.normal; camera space has y upwards and z to the eye.
vec3 normalOfTexel(uint octahedron) {
  const vec2 uv = unpackUnorm2x16(octahedron) * 2.0 - 1.0;
  const float z = 1.0 - abs(uv.x) - abs(uv.y);
  const vec2 folded = (1.0 - abs(uv.yx)) * mix(vec2(1.0), vec2(-1.0), lessThan(uv, vec2(0.0)));
  const vec2 across = z >= 0.0 ? uv : folded;
  return normalize(vec3(across.x, -across.y, -z));
}

// Normal of the plane with these slopes through an image point. In homogeneous image coordinates
// the plane is (slope, inv_z - slope point) P = 1; points in front of it have less.
vec3 normalOfSlopes(Pinhole pinhole, vec2 slope, vec3 point) {
  const vec3 metric =
      vec3(slope * pinhole.focal_px, point.z + dot(slope, pinhole.principal_px - point.xy));
  return -normalize(metric);
}

// The surface of a column that is nearest to a point, and the point on it.
Spot spotAt(Scene scene, vec3 point) {
  Spot spot;
  spot.cell = ivec2(clamp(point.xy, vec2(0.0), vec2(scene.extent.size_px - 1)));
  spot.layer = 0u;
  spot.point = point;
  float apart_min = 3.4e38;
  uint layer = 0u;
  for (;;) {
    if (isNever(scene, 10u)) break;
    const uvec2 facet = loadFacet(scene.layers, layer, scene.extent, spot.cell);
    const float inv_z = facetAtPoint(facet, spot.cell, point.xy);
    const float apart = inv_z < 0.0 ? 3.4e38 : abs(inv_z - point.z);
    const bool is_nearest = apart < apart_min;
    spot.layer = is_nearest ? layer : spot.layer;
    spot.point.z = is_nearest ? inv_z : spot.point.z;
    apart_min = min(apart, apart_min);
    ++layer;
    if (layer == scene.layer_count) break;
  }
  return spot;
}

// How it mirrors there: blended as its colour is. The sky mirrors nothing. `from_source`: from the
// camera in which normals are given.
Mirror mirrorAt(Scene scene, Pinhole pinhole, Address surfaces[kLayerCountMax], mat3 from_source,
                Spot spot) {
  const uint links = loadLinks(scene.layers, spot.layer, scene.extent, spot.cell);
  const SurfaceTaps taps = surfaceTaps(scene.layers, scene.extent, spot.layer, spot.cell, links,
                                       spot.point.xy, vec2(0.0));
  const uint count = uint(scene.extent.size_px.x * scene.extent.size_px.y);
  const uvec2 own = loadFacet(scene.layers, spot.layer, scene.extent, spot.cell);
  Mirror mirror;
  mirror.facet_normal = normalOfSlopes(pinhole, unpackSlopes(own.y), spot.point);
  vec3 normal = vec3(0.0);
  vec4 light = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    const SurfaceTexel texel =
        loadSurface(surfaces, taps.layers[i], count, uint(taps.px[i]));
    const ivec2 cell =
        ivec2(taps.px[i] % scene.extent.size_px.x, taps.px[i] / scene.extent.size_px.x);
    const uvec2 facet = loadFacet(scene.layers, taps.layers[i], scene.extent, cell);
    const vec3 at = vec3(vec2(cell) + 0.5, max(facetInvZ(facet), 0.0));
    normal += taps.weights[i] * (texel.normal == kNoNormal
                                     ? normalOfSlopes(pinhole, unpackSlopes(facet.y), at)
                                     : from_source * normalOfTexel(texel.normal));
    light += taps.weights[i] * unpackUnorm4x8(texel.light);
  }
  const float sum = taps.weights.x + taps.weights.y + taps.weights.z + taps.weights.w;
  mirror.normal = dot(normal, normal) > 0.0 ? normalize(normal) : mirror.facet_normal;
  mirror.light = spot.point.z > 0.0 ? light.rgb / sum : vec3(0.0);
  mirror.roughness = light.a / sum;
  return mirror;
}

// Seen from the source's camera, m along its axis.
vec3 metresOf(Pinhole pinhole, vec3 point) {
  return metricPoint(pinhole, vec3(point.xy, 1.0)) / point.z;
}

// A reflected ray, as it is walked.
struct Reflected {
  Ray ray;
  vec3 along;  // its direction in homogeneous image coordinates, for a metre
  float inv_z_tolerance;
  float eye_z;  // of the eye behind the mirror
};

// By how much an error in 1/Z moves the picture of a ray that comes from an eye (m): the larger of
// what it does at both ends of the ray (server/picture/trace_job.h; |r x b| grows and falls with
// the distance to a point).
float largestCross(Pinhole pinhole, Ray ray, vec3 eye) {
  const vec3 from = metricPoint(pinhole, vec3(ray.start.xy, 1.0));
  const vec3 to = metricPoint(pinhole, vec3(ray.start.xy + ray.extent.xy, 1.0));
  return max(length(cross(from, eye)), length(cross(to, eye)));
}

vec3 homogeneousPx(Pinhole pinhole, vec3 direction) {
  return vec3(direction.xy * pinhole.focal_px + direction.z * pinhole.principal_px, direction.z);
}

// Where rays from a place begin at the latest, in front of all that is known.
float nearOf(Scene scene, vec3 from) {
  return from.z > 0.0 ? max(scene.inv_z_near, kInvZNearMargin / from.z) : scene.inv_z_near;
}

Reflected reflectedAlong(Pinhole pinhole, Ray ray, vec3 along, vec3 eye, float moved_px) {
  const float cross = largestCross(pinhole, ray, eye);
  return Reflected(ray, along, min(moved_px / max(cross, 1e-30), 1e30), eye.z);
}

// From a place (homogeneous image coordinates, m) in a direction of unit length. `eye`: behind the
// mirror, in the middle of what is seen in it, m. `moved_px`: of the view, that an error may move
// the picture by, over the view's focal length.
Reflected reflectedRay(Scene scene, Pinhole pinhole, vec3 from, vec3 direction, vec3 eye,
                       float moved_px) {
  const vec3 along = homogeneousPx(pinhole, direction);
  const float near = nearOf(scene, from);
  const Ray ray = makeAnyRay(near * from, along, vec2(scene.extent.size_px), near);
  return reflectedAlong(pinhole, ray, along, eye, moved_px);
}

// The same in a face of a cube map.
Reflected reflectedFaceRay(Scene scene, Pinhole pinhole, vec3 from, vec3 direction, vec3 eye,
                           float moved_px, out FaceStretch stretch) {
  const vec3 along = homogeneousPx(pinhole, direction);
  const float near = nearOf(scene, from);
  const Ray ray = makeFaceRay(near * from, along, vec2(scene.extent.size_px), near, stretch);
  return reflectedAlong(pinhole, ray, along, eye, moved_px);
}

// Where a ray starts from a spot: in front of its surface, and of what is one with it, by what that
// may be off. Homogeneous image coordinates, m.
vec3 startBefore(Spot spot, float surface_error) {
  const float before = hasFault(kFaultStartsOnSurface) ? 0.0 : surface_error;
  return vec3(spot.point.xy, 1.0) / (spot.point.z + before);
}

#endif  // VIEWLOOM_LIB_MIRRORS_MIRROR_GLSL_
