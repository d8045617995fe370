// SPDX-License-Identifier: Apache-2.0
// Every kind of display with every effect, alone and all at once.
#include <cstring>

#include <gmock/gmock.h>

#include "e2e/atlas_viewer.h"
#include "e2e/reflected_share.h"
#include "e2e/service_fixture.h"
#include "e2e/wire_displays.h"
#include "synthetic/synthetic_wire_frame.h"

namespace viewloom::test::service_effects_test {
namespace {

using testing::StartsWith;

constexpr SizePx kSource_px{160, 90};
constexpr int64_t kInterval_ns = 100'000'000;
constexpr int64_t kBridge_ns = 250'000'000;  // the default
constexpr double kStep_m = 0.1;              // of the camera, along x, from frame to frame
constexpr double kFocus_m = 4;
constexpr double kAperture_m = 0.1;
// A lens blurs a surface over 2 x aperture x |1/Z - 1/focus| of the height at 1 m: beyond this the
// least picture of these, 39 px high, has more than 1.5 px of blur, and below that the tallest,
// 180 px, less than 1.
constexpr double kBlurred_per_m = 0.12;
constexpr double kSharp_per_m = 0.01;
constexpr double kChangedMin = 0.15;     // of the px; measured: 0.19 and more
constexpr double kBlurGainMin = 1.1;     // what is in focus next to what is not changes, too
constexpr double kSkyChangedMax = 0.08;  // px of panels, which show sky by a subpixel or two
constexpr double kShareRounding = 1e-9;

bool everywhere(double) {
  return true;
}

struct Kind {
  const char* name;
  void (*fill)(v1::OpenDisplay& open);
  bool has_focus = true;       // a plane of its own that a lens is focused on
  bool has_neighbours = true;  // views between which an automatic aperture finds its width
};

// Finer than what came: as coarse, a lens blends what is in focus with the px beside it.
void fineColorAndDepth(v1::OpenDisplay& open) {
  colorAndDepth(open);
  v1::RgbdDisplay& rgbd = *open.mutable_display()->mutable_rgbd();
  rgbd.mutable_view_size()->set_width(2 * kSource_px.width);
  rgbd.mutable_view_size()->set_height(2 * kSource_px.height);
}

const std::vector<Kind> kKinds = {
    {"quilt",
     [](auto& open) {
       *open.mutable_display() = openQuilt("scene", {160, 80}).display();
     }},
    {"panel", [](auto& open) { panel(open); }},
    {"microlenses", [](auto& open) { microlenses(open); }, false, true},
    {"stereo", [](auto& open) { eyes(open); }},
    {"tracked", [](auto& open) { eyes(open).set_tracked(true); }},
    {"grid", [](auto& open) { cameraGrid(open); }},
    {"list", [](auto& open) { cameraList(open); }, false, false},
    {"rgbd", [](auto& open) { fineColorAndDepth(open); }, false, false},
};

void addLens(v1::OpenDisplay& open) {
  v1::LensEffect& lens = *open.mutable_display()->mutable_effects()->mutable_lens();
  lens.set_aperture_radius_m(kAperture_m);
  lens.set_focus_distance_m(kFocus_m);
}
void addReflection(v1::OpenDisplay& open) {
  open.mutable_display()->mutable_effects()->mutable_reflection()->set_bounces(1);
}
void addTemporal(v1::OpenDisplay& open) {
  open.mutable_display()->mutable_effects()->mutable_temporal()->set_output_rate_hz(60);
}

// Share of changed pixels, or of changed subpixels of a panel.
class ChangedShare {
 public:
  void add(bool is_changed) {
    ++count_;
    changed_count_ += is_changed;
  }
  size_t count() const { return count_; }
  double share() const { return count_ == 0 ? 0 : double(changed_count_) / double(count_); }

 private:
  size_t count_ = 0;
  size_t changed_count_ = 0;
};

class ServiceEffectsTest : public ServiceFixture {
 protected:
  // Publishes two frames. The second shows how the camera moves.
  void SetUp() override {
    ServiceFixture::SetUp();
    if (IsSkipped()) return;
    Publisher publisher(makeChannel(service_->grpcAddress()),
                        {.stream = "scene", .session_id = "", .backoff = {}}, {});
    for (const int64_t number : {1, 2}) {
      Camera camera = syntheticCamera(kSource_px);
      camera.pose.position_m.x = double(number - 2) * kStep_m;
      publisher.offer(viewloom::syntheticWireFrame(
          {.size_px = kSource_px, .camera = camera, .thread_count = 1, .has_mirrors = true},
          number * kInterval_ns));
      AtlasViewer(service_->grpcAddress(), waiting()).waitForFrame(uint64_t(number));
    }
    ASSERT_TRUE(publisher.finish(std::chrono::nanoseconds(kGiveUpAfter).count()).ok());
  }

  static v1::OpenDisplay waiting() {
    v1::OpenDisplay open = openScene();
    cameraGrid(open);
    open.set_wait_for_stream(true);
    open.clear_count();
    return open;
  }

  static v1::OpenDisplay openOf(const Kind& kind) {
    v1::OpenDisplay open = openScene();
    kind.fill(open);
    open.mutable_encoding()->set_with_depth(true);
    open.mutable_display()->set_quality(v1::QUALITY_DRAFT);
    return open;
  }

  void expectRefused(const v1::OpenDisplay& open, const std::string& field) {
    AtlasViewer viewer(service_->grpcAddress(), open);
    ASSERT_TRUE(viewer.watcher().waitEnded(std::chrono::nanoseconds(kGiveUpAfter).count()));
    const absl::Status end = viewer.watcher().ended().value_or(absl::OkStatus());
    EXPECT_EQ(end.code(), absl::StatusCode::kFailedPrecondition);
    EXPECT_THAT(std::string(end.message()), StartsWith(field));
  }

  static AtlasPicture planeOf(const Atlas& atlas, v1::AtlasPlane plane) {
    auto picture = decodePlane(atlas, plane);
    EXPECT_TRUE(picture.ok()) << picture.status();
    return picture.ok() ? *std::move(picture) : AtlasPicture{};
  }

  static void expectSameSize(const Atlas& a, const Atlas& b) {
    EXPECT_EQ(a.layout->size().width(), b.layout->size().width());
    EXPECT_EQ(a.layout->size().height(), b.layout->size().height());
    EXPECT_EQ(planeOf(b, v1::ATLAS_PLANE_COLOR).samples.size(),
              3 * size_t{a.layout->size().width()} * a.layout->size().height());
  }

  // Over the px of which `counts` holds of 1/Z.
  static ChangedShare changedShare(const Atlas& plain, const Atlas& other,
                                   const std::function<bool(double inv_z)>& counts) {
    constexpr int kSame = 4;  // 8-bit codes: what samples of one surface differ by
    const AtlasPicture a = planeOf(plain, v1::ATLAS_PLANE_COLOR);
    const AtlasPicture b = planeOf(other, v1::ATLAS_PLANE_COLOR);
    const AtlasPicture depth = planeOf(plain, v1::ATLAS_PLANE_DEPTH);
    ChangedShare changed;
    for (size_t px = 0; 3 * px < a.samples.size(); ++px) {
      float inv_z = 0;
      std::memcpy(&inv_z, &depth.samples.at(sizeof inv_z * px), sizeof inv_z);
      if (!counts(double{inv_z})) continue;
      bool is_changed = false;
      for (size_t at = 3 * px; at < 3 * px + 3; ++at) {
        is_changed |= std::abs(int{a.samples[at]} - int{b.samples.at(at)}) > kSame;
      }
      changed.add(is_changed);
    }
    return changed;
  }

  static void expectBlurWhereOutOfFocus(const Atlas& plain, const Atlas& blurred) {
    const auto sharesWhere = [&](double min_per_m, double max_per_m) {
      return changedShare(plain, blurred, [=](double inv_z) {
        const double off_per_m = std::abs(inv_z - 1 / kFocus_m);
        return inv_z > 0 && off_per_m >= min_per_m && off_per_m < max_per_m;
      });
    };
    const ChangedShare off_focus = sharesWhere(kBlurred_per_m, 1);
    const ChangedShare in_focus = sharesWhere(0, kSharp_per_m);
    std::cout << "changed off focus " << off_focus.share() << ", in focus " << in_focus.share()
              << "\n";
    EXPECT_GT(off_focus.share(), kChangedMin);
    EXPECT_GT(off_focus.share(), kBlurGainMin * in_focus.share());
  }

  static void expectMirrorsOnSurfaces(const Atlas& plain, const Atlas& mirrored) {
    EXPECT_NEAR(reflectedShare(mirrored.end), 1, kShareRounding);
    const auto shareWhere = [&](bool is_sky) {
      return changedShare(plain, mirrored, [=](double inv_z) { return (inv_z == 0) == is_sky; })
          .share();
    };
    EXPECT_GT(shareWhere(false), kChangedMin);
    EXPECT_LT(shareWhere(true), kSkyChangedMax);
  }

  // The newest frame is long ago: as far ahead of it as a picture is bridged.
  static void expectCarriedOn(const Atlas& atlas) {
    EXPECT_EQ(atlas.header.frame_number(), 2U);
    EXPECT_EQ(atlas.header.timing(), v1::TIMING_HELD);
    EXPECT_EQ(atlas.header.shown_time_ns(), 2 * kInterval_ns + kBridge_ns);
    EXPECT_GT(atlas.header.display_pose().position().x(), kStep_m);
  }
};

TEST_F(ServiceEffectsTest, showsEachEffectOnEveryKind) {
  for (const Kind& kind : kKinds) {
    SCOPED_TRACE(kind.name);
    const Atlas plain = atlasOf(openOf(kind));
    EXPECT_EQ(plain.header.timing(), v1::TIMING_CAPTURED);
    EXPECT_EQ(reflectedShare(plain.end), 0);
    const auto atlasWith = [&](std::initializer_list<void (*)(v1::OpenDisplay&)> effects) {
      v1::OpenDisplay open = openOf(kind);
      for (const auto& add : effects) add(open);
      Atlas atlas = atlasOf(open);
      expectSameSize(plain, atlas);
      return atlas;
    };
    const Atlas blurred = atlasWith({addLens});
    expectBlurWhereOutOfFocus(plain, blurred);
    const Atlas mirrored = atlasWith({addReflection});
    expectMirrorsOnSurfaces(plain, mirrored);
    const Atlas later = atlasWith({addTemporal});
    expectCarriedOn(later);
    const Atlas all = atlasWith({addLens, addReflection, addTemporal});
    expectCarriedOn(all);
    EXPECT_NEAR(reflectedShare(all.end), 1, kShareRounding);
    for (const Atlas* other : {&plain, &blurred, &mirrored, &later}) {
      EXPECT_GT(changedShare(*other, all, everywhere).share(), kChangedMin);
    }
    EXPECT_GT(changedShare(plain, later, everywhere).share(), kChangedMin);
  }
}

TEST_F(ServiceEffectsTest, refusesALensThatTheDisplayGivesNoFocusOrNoWidth) {
  for (const Kind& kind : kKinds) {
    SCOPED_TRACE(kind.name);
    v1::OpenDisplay open = openOf(kind);
    addLens(open);
    v1::LensEffect& lens = *open.mutable_display()->mutable_effects()->mutable_lens();
    lens.clear_focus_distance_m();
    if (!kind.has_focus) expectRefused(open, "open.display.effects.lens.focus_distance_m: ");
    lens.set_focus_distance_m(kFocus_m);
    lens.clear_aperture_radius_m();
    lens.set_automatic_aperture(true);
    if (!kind.has_neighbours) expectRefused(open, "open.display.effects.lens.automatic_aperture: ");
  }
}

}  // namespace
}  // namespace viewloom::test::service_effects_test
