// SPDX-License-Identifier: Apache-2.0
// How rough surfaces mirror: the microfacets of GGX, sampled as far as they are seen.
#ifndef VIEWLOOM_LIB_GGX_GLSL_
#define VIEWLOOM_LIB_GGX_GLSL_

// A surface that mirrors less than 2 % head on mirrors less along it, too: none does else.
const float kReflectanceOfAll = 0.02;

// Schlick's: `cosine` of the angle to the microfacet's normal.
vec3 fresnel(vec3 head_on, float cosine) {
  const float along = min(max(head_on.r, max(head_on.g, head_on.b)) / kReflectanceOfAll, 1.0);
  const float rest = 1.0 - clamp(cosine, 0.0, 1.0);
  const float rest2 = rest * rest;
  return head_on + max(along - head_on, 0.0) * (rest2 * rest2 * rest);
}

// Two vectors across a normal (Duff et al., Building an Orthonormal Basis, Revisited, 2017).
mat3 basisAround(vec3 normal) {
  const float side = normal.z >= 0.0 ? 1.0 : -1.0;
  const float a = -1.0 / (side + normal.z);
  const float b = normal.x * normal.y * a;
  return mat3(vec3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x),
              vec3(b, side + normal.y * normal.y * a, -normal.y), normal);
}

// The normal of one of the microfacets that `towards` (unit length, to who looks) sees, in the
// space of the surface, z its normal: a place on the cap of a sphere (Dupuy and Benyoub, Sampling
// Visible GGX Normals with Spherical Caps, 2023). `alpha`: width. `place`: 0..1 each.
vec3 visibleNormal(vec3 towards, float alpha, vec2 place) {
  const vec3 stretched = normalize(vec3(alpha * towards.xy, towards.z));
  const float angle = 6.28318531 * place.x;
  const float z = (1.0 - place.y) * (1.0 + stretched.z) - stretched.z;
  const float across = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
  const vec3 halfway = vec3(across * cos(angle), across * sin(angle), z) + stretched;
  return normalize(vec3(alpha * halfway.xy, max(halfway.z, 1e-6)));
}

// Smith's, of the cosine to the normal.
float shadowing(float cosine, float alpha) {
  const float cosine2 = cosine * cosine;
  const float tangent2 = (1.0 - cosine2) / max(cosine2, 1e-12);
  return 0.5 * (sqrt(1.0 + alpha * alpha * tangent2) - 1.0);
}

// Of the light from a direction, by how much a visible microfacet passes it on beside its Fresnel:
// what others do not hide, of what they let see (G2 / G1, correlated heights).
float unshadowed(float cosine_in, float cosine_out, float alpha) {
  const float seen = 1.0 + shadowing(cosine_out, alpha);
  return seen / (seen + shadowing(cosine_in, alpha));
}

// Fractions of 2^32.
float inUnit(uint place) {
  return float(place >> 8) * (1.0 / 16777216.0);
}

// The i-th of `count` places in a unit square, for a px: a lattice, one in each stratum along x, so
// that the i-th rays of neighbouring px go about the same way. Those of 4x4 px are moved against
// each other by R2 of Roberts, and blocks at random; further bounces go by other lattices. The same
// in every frame.
vec2 samplePlace(uint i, uint count, uint bounce, uvec2 px, uint ray_index) {
  const uvec2 low = px & 3u;
  const uint crossed = low.x ^ low.y;
  const uint rank =
      ((crossed & 1u) << 3) | ((low.y & 1u) << 2) | (crossed & 2u) | ((low.y >> 1) & 1u);
  const uvec2 block = (px >> 2) + uvec2(ray_index << 16, bounce << 16);  // tiles have fewer
  uint turn = block.x * 0x9e3779b1u ^ (block.y * 0x85ebca77u + 0x27d4eb2fu);
  turn = (turn ^ (turn >> 15)) * 0x2c1b3c6du;
  turn = (turn ^ (turn >> 12)) * 0x297a2d39u;
  turn ^= turn >> 15;
  const uvec2 own = uvec2(0xc13fa9a9u, 0x91e10da5u) * rank + uvec2(turn, turn * 0x9e3779b1u);
  const uint across = 0x9e3779b9u + 0xbbe05633u * bounce;
  const float along = bounce == 0u ? (float(i) + inUnit(own.x)) / float(count)
                                   : inUnit(own.x + 0xdb4f0b91u * bounce * i);
  return vec2(along, inUnit(own.y + across * i));
}

#endif  // VIEWLOOM_LIB_GGX_GLSL_
