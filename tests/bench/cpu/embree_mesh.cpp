// SPDX-License-Identifier: Apache-2.0
#include "bench/cpu/embree_mesh.h"

#include <algorithm>
#include <vector>

#include <embree3/rtcore.h>

#include "base/check.h"
#include "bench/cpu/mesh_strip.h"
#include "bench/cpu/parallel_chunks.h"
#include "bench/cpu/ray_packet.h"

namespace viewloom::bench {
namespace {

constexpr uint32_t kStripRows = 24;
constexpr uint32_t kRowsPerChunk = 2;

RTCGeometry attachQuads(RTCDevice device, RTCScene scene) {
  const RTCGeometry quads = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
  rtcSetGeometryBuildQuality(quads, RTC_BUILD_QUALITY_LOW);
  rtcAttachGeometry(scene, quads);
  return quads;
}

void setQuads(RTCGeometry geometry, const std::vector<MeshVertex>& vertices, size_t vertex_count,
              const std::vector<MeshQuad>& quads) {
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             vertices.data(), 0, sizeof(MeshVertex), vertex_count);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, quads.data(), 0,
                             sizeof(MeshQuad), quads.size());
  rtcCommitGeometry(geometry);
}

}  // namespace

// Geometry 2 n is the cells of strip n, 2 n + 1 its rim.
struct EmbreeMesh::Scene {
  explicit Scene(const BenchLoad& bench_load);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void makeStrip(uint32_t index);
  void traceRows(float* inv_z);
  void traceRow(uint32_t first_view, uint32_t row, float* inv_z);
  // The colours around each ray's hit.
  void lookUp(const RayPacket& rays, const RTCRayHit16& hits, PacketColors& colors) const;

  const BenchLoad& load;
  RTCDevice device;
  RTCScene scene;
  std::vector<std::vector<MeshVertex>> vertices;  // [layer]
  std::vector<MeshStrip> strips;
  std::vector<RTCGeometry> geometries;
  std::vector<uint32_t> rgba;  // of the atlas
};

EmbreeMesh::Scene::Scene(const BenchLoad& bench_load)
    : load(bench_load), device(rtcNewDevice(nullptr)), scene(rtcNewScene(device)) {
  // Two levels, the lower by geometry. Robust, as rays of a view whose rows are the source's run
  // along the edges of quads, and one in a thousand would slip through.
  rtcSetSceneFlags(scene, RTCSceneFlags(RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST));
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
  const SizePx size_px = load.source.size_px;
  for (uint32_t layer = 0; layer < load.source.inv_z.size(); ++layer) {
    // One more, as Embree reads 16 bytes at each.
    std::vector<MeshVertex>& samples = vertices.emplace_back(size_px.area() + 1);
    for (size_t at = 0; at < size_px.area(); ++at) {
      samples[at].x_px = float(at % size_px.width) + 0.5F;
      samples[at].y_px = float(at / size_px.width) + 0.5F;
    }
    for (uint32_t row = 0; row <= size_px.height; row += kStripRows) {
      strips.push_back({.layer = layer,
                        .row_begin = row,
                        .row_end = std::min(row + kStripRows, size_px.height + 1)});
      geometries.push_back(attachQuads(device, scene));
      geometries.push_back(attachQuads(device, scene));
    }
  }
  rgba.resize(load.job.layout->size_px.area());
}

EmbreeMesh::Scene::~Scene() {
  for (const RTCGeometry geometry : geometries) rtcReleaseGeometry(geometry);
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
}

void EmbreeMesh::Scene::makeStrip(uint32_t index) {
  MeshStrip& strip = strips[index];
  std::vector<MeshVertex>& samples = vertices[strip.layer];
  const size_t width_px = load.source.size_px.width;
  const float* const inv_z = load.source.inv_z[strip.layer].data();
  const size_t last = std::min<size_t>(strip.row_end, load.source.size_px.height) * width_px;
  for (size_t at = strip.row_begin * width_px; at < last; ++at) {
    samples[at].inv_z = inv_z[at];
  }
  strip.make(load.source);
  const size_t rim_count = strip.rim_vertices.size();
  strip.rim_vertices.push_back({});
  setQuads(geometries[2 * size_t{index}], samples, samples.size() - 1, strip.quads);
  setQuads(geometries[2 * size_t{index} + 1], strip.rim_vertices, rim_count, strip.rim_quads);
}

void EmbreeMesh::Scene::lookUp(const RayPacket& rays, const RTCRayHit16& hits,
                               PacketColors& colors) const {
  const int width_px = int(load.source.size_px.width);
  const int height_px = int(load.source.size_px.height);
  for (uint32_t lane = 0; lane < kPacketSize; ++lane) {
    const uint32_t geometry = hits.hit.geomID[lane];
    if (geometry == RTC_INVALID_GEOMETRY_ID) {
      colors.setOne(lane, packBackground(load.job.background_rgb));
      continue;
    }
    const MeshStrip& strip = strips[geometry / 2];
    if (geometry % 2 == 1) {
      colors.setOne(lane, strip.rim_rgba[hits.hit.primID[lane]]);
      continue;
    }
    const float x = rays.from_x[lane] + hits.ray.tfar[lane] * rays.along_x[lane] - 0.5F;
    const float y = rays.from_y[lane] + hits.ray.tfar[lane] * rays.along_y[lane] - 0.5F;
    const int column = std::clamp(int(x), 0, width_px - 2);
    const int row = std::clamp(int(y), 0, height_px - 2);
    colors.setFour(lane, load.source.rgba[strip.layer].data() + row * width_px + column, width_px,
                   x - float(column), y - float(row));
  }
}

void EmbreeMesh::Scene::traceRow(uint32_t first_view, uint32_t row, float* inv_z) {
  RayPacket rays(load, first_view, row);
  PacketColors colors;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RTCRayHit16 hits;
  for (uint32_t column = 0; column < rays.width_px; column += rays.column_count) {
    rays.aim(column);
    for (uint32_t lane = 0; lane < kPacketSize; ++lane) {
      hits.ray.org_x[lane] = rays.from_x[lane];
      hits.ray.org_y[lane] = rays.from_y[lane];
      hits.ray.org_z[lane] = rays.from_inv_z[lane];
      hits.ray.dir_x[lane] = rays.along_x[lane];
      hits.ray.dir_y[lane] = rays.along_y[lane];
      hits.ray.dir_z[lane] = -rays.from_inv_z[lane];
      hits.ray.tnear[lane] = 0;
      hits.ray.tfar[lane] = kFarMargin;
      hits.ray.time[lane] = 0;
      hits.ray.mask[lane] = ~0U;
      hits.ray.flags[lane] = 0;
      hits.ray.id[lane] = 0;
      hits.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(rays.is_active, scene, &context, &hits);
    lookUp(rays, hits, colors);
    colors.blend();
    for (uint32_t lane = 0; lane < kPacketSize; ++lane) {
      if (rays.is_active[lane] == 0) continue;
      const size_t at = rays.offset_px[lane] + column;
      rgba[at] = colors.blended[lane];
      if (inv_z == nullptr || hits.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
      inv_z[at] = std::max(0.0F, rays.from_inv_z[lane] * (1 - hits.ray.tfar[lane]));
    }
  }
}

void EmbreeMesh::Scene::traceRows(float* inv_z) {
  const uint32_t view_count = uint32_t(load.job.tiles.size());
  forChunks(load.job.layout->tile_size_px.height, kRowsPerChunk,
            [&](uint32_t, uint32_t first, uint32_t last) {
              for (uint32_t row = first; row < last; ++row) {
                for (uint32_t view = 0; view < view_count; view += packetViews(view_count)) {
                  traceRow(view, row, inv_z);
                }
              }
            });
}

EmbreeMesh::EmbreeMesh() = default;
EmbreeMesh::~EmbreeMesh() = default;

bool EmbreeMesh::takes(const BenchLoad& load) const {
  return raysLookAhead(load);
}

void EmbreeMesh::prepare(const BenchLoad& load) {
  scene_ = std::make_unique<Scene>(load);
}

void EmbreeMesh::build() {
  forChunks(uint32_t(scene_->strips.size()), 1, [&](uint32_t, uint32_t first, uint32_t last) {
    for (uint32_t index = first; index < last; ++index) scene_->makeStrip(index);
  });
  rtcCommitScene(scene_->scene);
  VIEWLOOM_CHECK(rtcGetDeviceError(scene_->device) == RTC_ERROR_NONE);
}

void EmbreeMesh::trace() {
  scene_->traceRows(nullptr);
}

Picture EmbreeMesh::picture() {
  Picture picture;
  picture.inv_z.assign(scene_->rgba.size(), kNoSurface);
  scene_->traceRows(picture.inv_z.data());
  picture.rgba = scene_->rgba;
  return picture;
}

}  // namespace viewloom::bench
