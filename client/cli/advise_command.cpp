// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>

#include "base/str_cat.h"
#include "cli/display_options.h"
#include "cli/print_json.h"
#include "cli/report_error.h"
#include "cli/server_options.h"
#include "lib/catalog.h"

namespace viewloom::cli {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;
constexpr double kLevelTurn = 1e-9;  // of a quaternion: what rounding leaves of none

struct AdviseOptions {
  DisplayOptions display;
  double near_m = 0;
  double far_m = 0;
  bool as_json = false;
};

// To a micrometre: less is what rounding leaves of nothing.
double wholeMicrometres(double value_m) {
  return std::round(value_m * 1e6) / 1e6 + 0.0;  // + 0.0: no negative zero
}

std::string number(double value, int digits) {
  return formatNumber(value, digits);
}

std::string placeText(const v1::Pose& pose) {
  const v1::Vector3& at = pose.position();
  const v1::Quaternion& turn = pose.orientation();
  std::string text = strCat("at ", wholeMicrometres(at.x()), " ", wholeMicrometres(at.y()), " ",
                            wholeMicrometres(at.z()), " m");
  const bool is_turned = std::hypot(turn.x(), turn.y(), turn.z()) > kLevelTurn;
  if (is_turned) {
    text += strCat(", turned by the quaternion ", turn.x(), " ", turn.y(), " ", turn.z(), " ",
                   turn.w(), " (x y z w)");
  }
  return text;
}

// A side of an image of so many px, with its axis at principal_px.
struct Angles {
  double before_deg = 0;
  double behind_deg = 0;

  Angles(double focal_px, double principal_px, uint32_t side_px)
      : before_deg(std::atan(principal_px / focal_px) * kDegPerRad),
        behind_deg(std::atan((side_px - principal_px) / focal_px) * kDegPerRad) {}
  double sum() const { return before_deg + behind_deg; }
};

void printSource(const char* name, const v1::Camera& camera, const v1::SizePx& size) {
  const v1::Intrinsics& pinhole = camera.intrinsics();
  const Angles across(pinhole.focal_x_px(), pinhole.principal_x_px(), size.width());
  const Angles down(pinhole.focal_y_px(), pinhole.principal_y_px(), size.height());
  std::printf("%s\n", name);
  std::printf("  camera         %s\n", placeText(camera.pose()).c_str());
  std::printf("  field of view  %s x %s degrees: %s left, %s right, %s up, %s down of its axis\n",
              number(across.sum(), 2).c_str(), number(down.sum(), 2).c_str(),
              number(across.before_deg, 2).c_str(), number(across.behind_deg, 2).c_str(),
              number(down.before_deg, 2).c_str(), number(down.behind_deg, 2).c_str());
  std::printf("  size           %ux%u px, focal length %s x %s px\n", size.width(), size.height(),
              number(pinhole.focal_x_px(), 2).c_str(), number(pinhole.focal_y_px(), 2).c_str());
}

void print(const v1::AdviseSourceResponse& advice) {
  printSource("source", advice.camera(), advice.size());
  std::printf("  layers         %u\n", advice.layer_count());
  if (advice.has_second_source()) {
    printSource("second source", advice.second_source(), advice.second_size());
  }
}

absl::StatusOr<v1::AdviseSourceRequest> makeRequest(const AdviseOptions& options) {
  if (!hasOwnFov(options.display)) {
    return absl::InvalidArgumentError(
        "--fov is missing: without a stream, the display has no field of view to copy. Give the "
        "vertical field of view of its views in degrees, for example --fov 14");
  }
  absl::StatusOr<v1::Display> display = makeDisplay(options.display);
  if (!display.ok()) return display.status();
  v1::AdviseSourceRequest request;
  *request.mutable_display() = *std::move(display);
  request.set_near_m(options.near_m);
  request.set_far_m(options.far_m);
  return request;
}

int advise(const AdviseOptions& options, const CommonOptions& common) {
  const absl::StatusOr<v1::AdviseSourceRequest> request = makeRequest(options);
  if (!request.ok()) {
    reportError(request.status(), common);
    return kExitUsage;
  }
  const auto advice = Catalog(channelTo(common)).adviseSource(*request);
  if (!advice.ok()) return reportError(advice.status(), common);
  if (!options.as_json) {
    print(*advice);
    return kExitDone;
  }
  const absl::Status printed = printJson(*advice);
  return printed.ok() ? kExitDone : reportError(printed, common);
}

}  // namespace

RunCommand addAdviseCommand(const usage::Command& app) {
  const auto options = std::make_shared<AdviseOptions>();
  app.footer(
      "Examples:\n"
      "  viewloom advise --preset portrait --fov 14 --near 0.5 --far 3\n"
      "  viewloom advise --display panel.json --near 1 --far 1000 --json");
  const usage::Option file = addDisplayShape(app, options->display);
  app.add("--fov", options->display.fov_y_deg,
          "Vertical field of view of each view; required unless the display sets it")
      .valueName("DEGREES")
      .excludes(file)
      .group("Display");
  addPanelOptions(app, options->display);
  app.add("--near", options->near_m, "Depth of the nearest surface of the scene, more than 0")
      .valueName("METRES")
      .required();
  app.add("--far", options->far_m, "Depth of the farthest surface of the scene, up to 1e9")
      .valueName("METRES")
      .required();
  app.addFlag("--json", options->as_json, "Print the answer of the server as JSON");
  return [options](const CommonOptions& common) { return advise(*options, common); };
}

}  // namespace viewloom::cli
