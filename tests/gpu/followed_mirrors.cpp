// SPDX-License-Identifier: Apache-2.0
#include "gpu/followed_mirrors.h"

#include <algorithm>
#include <cstring>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "gpu/commands.h"
#include "gpu/judge_views.h"
#include "oracle/mirrored_ray.h"
#include "oracle/passed_body.h"
#include "shaders/follow_mirrors.h"
#include "shared/reflection_abi.h"
#include "trace/band_params.h"
#include "trace/mirrored_structure.h"

namespace viewloom {
namespace {

constexpr uint32_t kMirrorsAll = 0x00ffffff;  // abi::SurfaceTexel::light of a perfect mirror

// Errors are seen from behind the mirror, further away than where rays start, which the judge takes
// for their eye: there the same error is worth more px.
constexpr double kNearerThanEye = 10;

// The same values as in shaders/lib/mirrors/mirrored_path.glsl and walk.glsl.
constexpr double kSigmasOfSurface = 4;
constexpr double kRoundingUlps = 16;
constexpr double kUlp = 0x1p-23;

// By how much the device's places may be off: what is said of a place moved by that excuses it.
constexpr double kPlace_px = 0.001;
constexpr double kPlaceShare = 1e-5;  // of 1/Z

DisplaySpec displayOf(const std::vector<oracle::OutputView>& views, double tolerance_px) {
  const oracle::OutputView& first = views.front();
  CamerasSpec cameras{.cameras = {},
                      .tile_size_px = {uint32_t(first.width), uint32_t(first.height)},
                      .columns = uint32_t(views.size())};
  for (const oracle::OutputView& view : views) {
    const Intrinsics intrinsics{view.pinhole.focal_px, view.pinhole.principal_px};
    cameras.cameras.push_back({{view.position_m, view.orientation}, intrinsics});
  }
  DisplaySpec spec;
  spec.kind = cameras;
  spec.tolerance_px = tolerance_px;
  spec.reflection = ReflectionSpec{.bounce_count = 1, .sample_count = 1};
  const auto completed = completeDisplaySpec(spec);
  if (!completed.ok()) throw std::runtime_error(std::string(completed.status().message()));
  return *completed;
}

template <typename Element>
void appendTile(const AtlasLayout& layout, uint32_t tile, const std::vector<Element>& atlas,
                std::vector<Element>& to) {
  const TileOrigin origin = layout.tileOrigin(tile);
  for (uint32_t row = 0; row < layout.tile_size_px.height; ++row) {
    const auto first = atlas.begin() + ptrdiff_t(origin.y_px + row) * layout.size_px.width +
                       ptrdiff_t(origin.x_px);
    to.insert(to.end(), first, first + layout.tile_size_px.width);
  }
}

oracle::TestedAnswer answerOf(const abi::FollowedRay& ray) {
  oracle::TestedAnswer answer = testedAnswer(abi::RayRecord{.x_px = ray.x_px,
                                                            .y_px = ray.y_px,
                                                            .inv_z = ray.inv_z,
                                                            .ray_class = ray.ray_class,
                                                            .layer = ray.layer,
                                                            .visits = 0});
  answer.is_back = ray.is_back != 0;
  return answer;
}

// Both axes of the view, turned with the ray as by a mirror: what matters is by how much.
oracle::ViewRay seenAs(const oracle::Ray& ray, double px_rad) {
  const glm::dvec3 other =
      std::abs(ray.direction.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(other, ray.direction));
  return {ray, px_rad * right, px_rad * glm::cross(ray.direction, right)};
}

oracle::MirrorTolerance mirrorTolerance(const SourceStats& stats, double moved_rad) {
  return {.moved_rad = moved_rad,
          .measured = std::max(stats.depth_step, kSigmasOfSurface * stats.noise_sigma),
          .rounding = kRoundingUlps * kUlp * stats.inv_z_max};
}

oracle::BodyAnswer bodyAnswerOf(const abi::FollowedRay& ray) {
  return {ray.body == abi::kBodyMet      ? oracle::BehindBody::kMet
          : ray.body == abi::kBodyPassed ? oracle::BehindBody::kPassed
                                         : oracle::BehindBody::kUnknown,
          {ray.body_x_px, ray.body_y_px, ray.body_inv_z}};
}

void judgeBody(const oracle::OracleSource& source, const oracle::MirrorSpot& spot,
               const abi::FollowedRay& ray, const std::string& where, JudgedBodies& judged) {
  if (ray.passed_inv_z < 0) return;
  const glm::dvec3 begin(spot.x_px, spot.y_px, spot.inv_z);
  const glm::dvec3 passed(ray.passed_x_px, ray.passed_y_px, ray.passed_inv_z);
  const glm::dvec3 end(ray.x_px, ray.y_px, ray.inv_z);
  const oracle::BodyAnswer got = bodyAnswerOf(ray);
  judged.met_count += got.behind == oracle::BehindBody::kMet;
  judged.passed_count += got.behind == oracle::BehindBody::kPassed;
  ++judged.count;
  if (got.agrees(oracle::behindBody(source, begin, passed, end), kPlace_px)) return;
  for (int way = 0; way < 8; ++way) {
    const glm::dvec3 moved((way & 1 ? 1 : -1) * kPlace_px, (way & 2 ? 1 : -1) * kPlace_px,
                           (way & 4 ? 1 : -1) * kPlaceShare * passed.z);
    const bool is_excused =
        got.agrees(oracle::behindBody(source, begin, passed + moved, end), 4 * kPlace_px) ||
        got.agrees(oracle::behindBody(source, begin, passed, end + moved), 4 * kPlace_px);
    if (!is_excused) continue;
    ++judged.excused_count;
    return;
  }
  ++judged.differing_count;
  if (judged.differing_count <= 3) std::cout << where << ": differs behind a body\n";
}

}  // namespace

FramePtr mirroringFrameOf(const oracle::Scene& scene) {
  auto frame = std::make_shared<Frame>(*frameOf(scene));
  SourceFormat& source = frame->format.sources.front();
  for (size_t layer = 0; layer < source.layers.size(); ++layer) {
    const SizePx size_px = source.layers[layer].depth.size_px;
    source.layers[layer].others = {{.kind = PlaneKind::kSpecular, .size_px = size_px, .depth = {}}};
    const std::vector<abi::SurfaceTexel> texels(
        size_px.area(), abi::SurfaceTexel{.normal = abi::kNoNormal, .light = kMirrorsAll});
    std::vector<uint8_t> bytes(texels.size() * sizeof(abi::SurfaceTexel));
    std::memcpy(bytes.data(), texels.data(), bytes.size());
    frame->sources.front()[layer].surface =
        std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
  }
  return frame;
}

MirrorFollower::MirrorFollower(const Device& device)
    : device_(device),
      kernels_(device),
      albedos_(device),
      pass_(device,
            {.spirv = follow_mirrors_spirv,
             .push_bytes = sizeof(abi::TracePush),
             .descriptors = mirrorSlots({{abi::kBindingReflected, DescriptorKind::kStorage},
                                         {abi::kBindingFollowed, DescriptorKind::kStorage}}),
             .debug_name = "follow mirrors"}) {}

std::vector<abi::FollowedRay> MirrorFollower::follow(MirrorStage& stage) {
  std::vector<abi::FollowedRay> followed(stage.layout().size_px.area());
  const uint64_t size_bytes = followed.size() * sizeof(abi::FollowedRay);
  const ReadablePlane rays(device_, size_bytes, "followed rays");
  stage.timedMs([&](Commands commands, const ReflectedRows& rows) {
    std::vector<Descriptor> descriptors = mirrorDescriptors(rows.structure, rows.params, albedos_);
    descriptors.push_back(wholeBuffer(abi::kBindingReflected, rows.reflected));
    descriptors.push_back(wholeBuffer(abi::kBindingFollowed, rays.target()));
    commands.fill(rays.target(), 0);
    recordTransferToCompute(commands);
    pass_.recordDescriptors(commands, descriptors);
    pass_.record(commands, rows.push, groupCount(rows.push.atlas_width_px), rows.row_count);
    recordComputeToTransfer(commands);
    rays.recordReadback(commands, size_bytes);
    recordTransferToHost(commands);
    recordComputeToHost(commands);
  });
  std::memcpy(followed.data(), rays.bytes().data(), size_bytes);
  return followed;
}

FollowedViews MirrorFollower::follow(const oracle::Scene& scene,
                                     const std::vector<oracle::OutputView>& views,
                                     double tolerance_px) {
  MirrorStage stage(kernels_, *mirroringFrameOf(scene), displayOf(views, tolerance_px));
  const std::vector<abi::FollowedRay> atlas = follow(stage);
  FollowedViews followed{.stats = stage.stats(), .records = {}, .followed = {}};
  for (uint32_t view = 0; view < views.size(); ++view) {
    appendTile(stage.layout(), view, stage.records(), followed.records);
    appendTile(stage.layout(), view, atlas, followed.followed);
  }
  return followed;
}

void JudgedBodies::add(const JudgedBodies& other) {
  count += other.count;
  met_count += other.met_count;
  passed_count += other.passed_count;
  excused_count += other.excused_count;
  differing_count += other.differing_count;
}

void JudgedMirrors::add(const JudgedMirrors& other) {
  verdict.add(other.verdict);
  bodies.add(other.bodies);
  bent_count += other.bent_count;
  back_count += other.back_count;
  deeper_count += other.deeper_count;
}

std::string JudgedMirrors::summary() const {
  std::ostringstream text;
  text << verdict.summary() << "\n"
       << bent_count << " bent, " << back_count << " out through a surface, " << deeper_count
       << " from deeper layers; " << bodies.count << " passed behind bodies, met "
       << bodies.met_count << " and " << bodies.passed_count << " not, excused "
       << bodies.excused_count << ", " << bodies.differing_count << " differ";
  return text.str();
}

JudgedMirrors judgeMirrors(MirrorFollower& follower, const oracle::Scene& scene,
                           const std::vector<oracle::OutputView>& views, double tolerance_px,
                           const std::string& where) {
  const FollowedViews traced = follower.follow(scene, views, tolerance_px);
  const oracle::OracleSource source = sourceOf(scene, traced.stats);
  oracle::Judge judge(source, oracle::toleranceOf(source, kNearerThanEye * tolerance_px));
  JudgedMirrors judged;
  size_t i = 0;
  for (const oracle::OutputView& view : views) {
    const double px_rad = 1 / view.pinhole.focal_px.x;
    const oracle::MirrorTolerance tolerance = mirrorTolerance(traced.stats, tolerance_px * px_rad);
    for (int px = 0; px < view.width * view.height; ++px, ++i) {
      const abi::FollowedRay& followed = traced.followed[i];
      if (followed.is_traced == 0) continue;
      const abi::RayRecord& record = traced.records[i];
      const oracle::MirrorSpot spot =
          oracle::mirrorSpotAt(source, record.x_px, record.y_px, record.inv_z);
      const oracle::MirroredRay goes = oracle::mirrored(source, spot, view.position_m, tolerance);
      std::ostringstream name;
      name << where << ", view " << view.name << " px (" << px % view.width << ", "
           << px / view.width << ") from layer " << spot.facet.layer << " at (" << spot.x_px << ", "
           << spot.y_px << ", " << spot.inv_z << ")" << (goes.is_bent ? ", bent" : "");
      judge.considerFrom(spot.facet.layer, seenAs(goes.ray, px_rad), answerOf(followed),
                         name.str());
      judgeBody(source, spot, followed, name.str(), judged.bodies);
      judged.bent_count += goes.is_bent;
      judged.back_count += followed.is_back;
      judged.deeper_count += spot.facet.layer > 0;
    }
  }
  judged.verdict = judge.verdict();
  return judged;
}

}  // namespace viewloom
