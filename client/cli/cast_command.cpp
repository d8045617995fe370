// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <numbers>
#include <thread>
#include <variant>

#include "base/printable.h"
#include "base/str_cat.h"
#include "bridge/bridge.h"
#include "bridge/quilt_page.h"
#include "certificates/server_address.h"
#include "cli/interrupt.h"
#include "cli/print_json.h"
#include "display/named_display.h"
#include "lib/tls_parts.h"
#include "viewloom/v1/atlas.pb.h"
#include "viewloom/v1/display.pb.h"

namespace viewloom::cli {
namespace {

using bridge::AddressedQuilt;
using bridge::Bridge;
using bridge::BridgeDisplay;
using bridge::HttpAddress;
using bridge::QuiltQuery;

constexpr std::chrono::milliseconds kTick{20};  // how soon an interrupt is seen
constexpr uint16_t kBridgePort = 33334;
constexpr uint16_t kPagePort = 8080;
constexpr int kFirstDisplay = -1;

struct CastOptions {
  std::string stream = "demo";
  std::string bridge = "http://localhost:33334";
  std::string address = "http://127.0.0.1:8080";
  std::string preset;
  double view_cone_deg = 0;
  double focal_distance_m = 0;
  uint32_t jpeg_quality = 85;
  int display_index = kFirstDisplay;
  double every_s = 0;
  bool is_motion = false;
  double timeout_s = 15;
};

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<int64_t>(1e3 * seconds));
}

bridge::Patience patienceOf(const CastOptions& options) {
  return {.timeout = milliseconds(options.timeout_s), .has_given_up = &isInterrupted};
}

int fail(const absl::Status& status) {
  std::fprintf(stderr, "viewloom: %s\n",
               printable({status.message().data(), status.message().size()}, true).c_str());
  if (absl::IsInvalidArgument(status)) return kExitUsage;
  return absl::IsUnavailable(status) ? kExitNoServer : kExitFailed;
}

absl::StatusOr<BridgeDisplay> pick(const std::vector<BridgeDisplay>& displays, int index) {
  std::string there;
  for (const BridgeDisplay& display : displays) {
    if (index == kFirstDisplay || display.index == index) return display;
    there += strCat(there.empty() ? "" : ", ", display.index, " (", display.name, ")");
  }
  return absl::InvalidArgumentError(
      strCat("--head ", index, ": Bridge has no such display. It has ", there));
}

absl::StatusOr<QuiltQuery> makeQuery(const CastOptions& options, const BridgeDisplay& device) {
  v1::Display display;
  v1::QuiltDisplay& quilt = *display.mutable_quilt();
  quilt.set_view_cone_rad(options.view_cone_deg * std::numbers::pi / 180);
  quilt.set_focal_distance_m(options.focal_distance_m);
  v1::AtlasEncoding encoding;
  encoding.set_jpeg_quality(options.jpeg_quality);
  if (!options.preset.empty()) {
    quilt.set_preset(options.preset);
  } else if (device.default_quilt) {
    const bridge::QuiltShape& shape = *device.default_quilt;
    quilt.set_columns(shape.columns);
    quilt.set_rows(shape.rows);
    quilt.set_aspect(shape.aspect);
    quilt.mutable_size()->set_width(shape.width_px);
    quilt.mutable_size()->set_height(shape.height_px);
  } else {
    return absl::FailedPreconditionError(strCat(
        device.name,
        " does not tell which quilt it needs. Name one with --preset: `viewloom list presets` "
        "lists them"));
  }
  return QuiltQuery{.stream = options.stream,
                    .display = compactJson(display),
                    .encoding = compactJson(encoding),
                    .is_motion = options.is_motion};
}

// Refuses presets that Bridge cannot show. Names that are unknown here are the server's to judge.
absl::Status checkShape(const CastOptions& options) {
  const absl::StatusOr<DisplayKind> named = namedDisplay(options.preset);
  if (!named.ok() || std::holds_alternative<QuiltSpec>(*named)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      strCat("--preset ", options.preset,
             " is not a quilt, and Bridge shows only quilts. `viewloom list presets` lists quilts. "
             "`viewloom watch ",
             options.stream, " --preset ", options.preset, " --out FOLDER` saves this display"));
}

// The address for people: a link in it is as good as a password for an hour.
std::string shownAddress(const std::string& uri) {
  const size_t link = uri.find("link=");
  return printable(link == std::string::npos ? uri : strCat(uri.substr(0, link), "link=..."));
}

absl::Status showQuilt(const CastOptions& options, const HttpAddress& page, const QuiltQuery& query,
                       const BridgeDisplay& display, absl::StatusOr<AddressedQuilt>& quilt,
                       Bridge& to) {
  // A link expires, other addresses stay.
  if (!quilt.ok() || !query.token.empty()) {
    quilt = bridge::findQuilt(page, query, patienceOf(options));
    VIEWLOOM_RETURN_IF_ERROR(quilt.status());
  }
  VIEWLOOM_RETURN_IF_ERROR(to.play(*quilt, display.index));
  std::printf("%s shows %s\n", printable(display.name).c_str(), shownAddress(quilt->uri).c_str());
  std::fflush(stdout);
  return absl::OkStatus();
}

// Shows the quilt, and again every so often, until it is interrupted. CANCELLED if that comes
// before the first time.
absl::Status cast(const CastOptions& options, const HttpAddress& page, const std::string& token,
                  Bridge& to) {
  VIEWLOOM_RETURN_IF_ERROR(to.enter());
  const absl::StatusOr<std::vector<BridgeDisplay>> displays = to.displays();
  VIEWLOOM_RETURN_IF_ERROR(displays.status());
  const absl::StatusOr<BridgeDisplay> display = pick(*displays, options.display_index);
  VIEWLOOM_RETURN_IF_ERROR(display.status());
  absl::StatusOr<QuiltQuery> query = makeQuery(options, *display);
  VIEWLOOM_RETURN_IF_ERROR(query.status());
  query->token = token;
  absl::StatusOr<AddressedQuilt> quilt = absl::UnknownError("not asked for yet");
  bool has_shown = false;
  do {
    const absl::Status shown = showQuilt(options, page, *query, *display, quilt, to);
    if (absl::IsCancelled(shown) && has_shown) break;
    VIEWLOOM_RETURN_IF_ERROR(shown);
    has_shown = true;
    const auto due = std::chrono::steady_clock::now() + milliseconds(options.every_s);
    while (!isInterrupted() && std::chrono::steady_clock::now() < due) {
      std::this_thread::sleep_for(kTick);
    }
  } while (options.every_s > 0 && !isInterrupted());
  return absl::OkStatus();
}

// The page's address, with what its encryption needs.
absl::StatusOr<HttpAddress> pageAddress(const CastOptions& options, const TlsOptions& tls) {
  const ServerAddress address = parseServerAddress(options.address);
  VIEWLOOM_RETURN_IF_ERROR(checkTlsOptions(address, tls));
  std::shared_ptr<const TlsParts> parts;
  if (address.has_tls) {
    absl::StatusOr<TlsParts> read = readTlsParts(tls);
    VIEWLOOM_RETURN_IF_ERROR(read.status());
    parts = std::make_shared<const TlsParts>(*std::move(read));
  }
  return bridge::parseHttpAddress(options.address, kPagePort, "--address", std::move(parts));
}

int run(const CastOptions& options, const CommonOptions& common) {
  if (const absl::Status shape = checkShape(options); !shape.ok()) return fail(shape);
  const absl::StatusOr<HttpAddress> bridge_address =
      bridge::parseHttpAddress(options.bridge, kBridgePort, "--bridge");
  if (!bridge_address.ok()) return fail(bridge_address.status());
  const absl::StatusOr<HttpAddress> page = pageAddress(options, common.tls);
  if (!page.ok()) return fail(page.status());
  if (page->isLoopback() && !bridge_address->isLoopback()) {
    return fail(absl::InvalidArgumentError(
        strCat("--address ", page->url(), ": Bridge at ", bridge_address->url(),
               " runs on another machine and cannot reach this address. Start viewloomd on an "
               "address of the network (--http.address), and give that address with --address")));
  }
  catchInterrupts();
  Bridge to(*bridge_address, patienceOf(options));
  const absl::Status status = cast(options, *page, common.token, to);
  if (absl::IsCancelled(status)) {
    return fail(absl::CancelledError("interrupted before the display showed the stream"));
  }
  return status.ok() ? int{kExitDone} : fail(status);
}

}  // namespace

RunCommand addCastCommand(const usage::Command& app) {
  const auto options = std::make_shared<CastOptions>();
  app.footer(
      "Examples:\n"
      "  viewloom cast                                    stream \"demo\", as the display needs "
      "it\n"
      "  viewloom cast scan --preset portrait --every 2\n"
      "  viewloom cast --bridge http://10.0.0.7 --address http://10.0.0.5:8080\n"
      "  viewloom cast --address https://studio.example --token-file wall.token");
  app.add("stream", options->stream, "Name of the stream").showDefault();
  app.add("--bridge", options->bridge, "Address of Looking Glass Bridge")
      .valueName("URL")
      .showDefault();
  app.add("--address", options->address,
          "Address of viewloomd's page, as Bridge reaches it; https:// for TLS")
      .valueName("URL")
      .showDefault();
  app.add("--preset", options->preset,
          "Quilt of a known device; `viewloom list presets` lists them")
      .valueName("NAME")
      .defaultText("the quilt that the display asks for");
  app.add("--cone", options->view_cone_deg, "Angle between the outermost views, more than 0")
      .valueName("DEGREES")
      .positive()
      .defaultText("the preset's, else 40");
  app.add("--focal-distance", options->focal_distance_m,
          "Distance of the focal plane, which has no parallax")
      .valueName("METRES")
      .positive()
      .defaultText("from the content");
  app.add("--quality", options->jpeg_quality, "JPEG quality, 1 to 100")
      .between(1, 100)
      .showDefault();
  app.add("--head", options->display_index, "Index that Bridge gives the display, 0 to 255")
      .between(0, 255)
      .defaultText("the first display");
  const usage::Option every =
      app.add("--every", options->every_s,
              "Send a new still at this interval until Ctrl-C, 0.1 to 86400")
          .valueName("SECONDS")
          .between(0.1, 86400.0)
          .defaultText("one still");
  app.addFlag("--motion", options->is_motion,
              "Send the motion JPEG stream instead of stills (not tested on a display)")
      .excludes(every);
  app.add("--timeout", options->timeout_s, "Longest wait for each answer, 0.1 to 600")
      .valueName("SECONDS")
      .between(0.1, 600.0)
      .showDefault();
  return [options](const CommonOptions& common) -> int { return run(*options, common); };
}

}  // namespace viewloom::cli
