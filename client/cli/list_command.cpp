// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/str_cat.h"
#include "cli/page_address.h"
#include "cli/print_json.h"
#include "cli/report_error.h"
#include "cli/server_options.h"
#include "lib/catalog.h"

namespace viewloom::cli {
namespace {

const std::vector<std::string> kLists{"streams", "displays", "presets", "server", "all"};

std::string joined(const auto& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

// Most slips are addresses: "127.0.0.1:50051", "[::1]:50051", "unix:/run/viewloom".
bool isAddress(const std::string& word) {
  return word.find(':') != std::string::npos;
}

std::string unknownList(const std::string& word) {
  std::string text =
      strCat("unknown list \"", printable(word), "\". Known lists: ", joined(kLists), ".");
  if (isAddress(word)) {
    return strCat(text, " Did you mean \"viewloom list --server ", printable(word), "\"?");
  }
  const std::string meant = nearestName(word, kLists);
  return meant.empty() ? text : strCat(text, " Did you mean \"viewloom list ", meant, "\"?");
}

struct ListOptions {
  std::string what = "all";
  bool as_json = false;
};

// "-": not known.
std::string sizeText(const v1::SizePx& size) {
  if (size.width() == 0) return "-";
  return strCat(size.width(), "x", size.height());
}

void print(const v1::ListStreamsResponse& response) {
  std::printf(
      "STREAM               STATE    FRAME      SIZE       LAYERS  RATE/S  REPLACED  REFUSED  "
      "WATCHERS\n");
  for (const v1::StreamEntry& stream : response.streams()) {
    std::printf("%-20s %-8s %-10llu %-10s %-7u %-7.1f %-9llu %-8llu %u\n",
                printable(stream.name()).c_str(), stream.live() ? "live" : "ended",
                static_cast<unsigned long long>(stream.frame_number()),
                sizeText(stream.size()).c_str(), stream.layer_count(), stream.rate_hz(),
                static_cast<unsigned long long>(stream.replaced_count()),
                static_cast<unsigned long long>(stream.refused_count()), stream.subscriber_count());
  }
}

void print(const v1::ListDisplaysResponse& response) {
  std::printf("DISPLAY  STREAM               ATLAS        VIEWS  WATCHERS  ATLASES  RUNG\n");
  for (const v1::DisplayEntry& display : response.displays()) {
    const uint32_t rung = display.layout().video_rung();
    std::printf("%-8llu %-20s %-12s %-6u %-9u %-8llu %s\n",
                static_cast<unsigned long long>(display.id()), printable(display.stream()).c_str(),
                sizeText(display.layout().size()).c_str(), display.layout().view_count(),
                display.subscriber_count(), static_cast<unsigned long long>(display.atlas_count()),
                rung == 0 ? "-" : strCat(rung).c_str());
  }
}

void print(const v1::ListPresetsResponse& response) {
  std::printf(
      "PRESET           ATLAS        GRID     ASPECT  KINDS              PANEL        DEVICE\n");
  for (const v1::Preset& preset : response.presets()) {
    const v1::AtlasLayout& layout = preset.layout();
    char aspect[16] = "-";
    if (layout.aspect() > 0) std::snprintf(aspect, sizeof aspect, "%.4g", layout.aspect());
    std::printf("%-16s %-12s %-8s %-7s %-18s %-12s %s\n", printable(preset.name()).c_str(),
                sizeText(layout.size()).c_str(),
                strCat(layout.columns(), "x", layout.rows()).c_str(), aspect,
                printable(joined(preset.kinds())).c_str(), sizeText(preset.panel_size()).c_str(),
                printable(preset.device()).c_str());
    if (!preset.note().empty()) std::printf("%-16s %s\n", "", printable(preset.note()).c_str());
  }
}

// A line; empty for an older server.
const char* reachText(v1::Reach reach) {
  switch (reach) {
    case v1::REACH_MACHINE:
      return "reach: this machine alone\n";
    case v1::REACH_PROTECTED:
      return "reach: other machines, encrypted, for those who are let in\n";
    case v1::REACH_OPEN:
      return "reach: OPEN to anybody on the network (viewloomd --open)\n";
    default:
      return "";
  }
}

void print(const v1::GetServerInfoResponse& info, const std::string& page) {
  std::printf("viewloomd %s on %s (%s)%s\n", printable(info.version()).c_str(),
              printable(info.device()).c_str(), printable(info.driver()).c_str(),
              info.traces_on_cpu() ? ", renders on the CPU" : "");
  std::printf("limits: frames of %.0f MB, %u px per side, %u layers; atlases of %u px per side\n",
              static_cast<double>(info.ingest_limits().frame_bytes_max()) * 1e-6,
              info.ingest_limits().plane_side_px_max(), info.ingest_limits().layer_count_max(),
              info.atlas_side_px_max());
  if (!page.empty()) std::printf("page: %s\n", printable(page).c_str());
  if (!info.containment().empty())
    std::printf("containment: %s\n", printable(info.containment()).c_str());
  std::printf("%s", reachText(info.reach()));
}

template <typename Response>
absl::Status show(const absl::StatusOr<Response>& response, bool as_json) {
  if (!response.ok()) return response.status();
  if (!as_json) {
    print(*response);
    return absl::OkStatus();
  }
  return printJson(*response);
}

absl::Status showServer(absl::StatusOr<v1::GetServerInfoResponse> info, const std::string& server,
                        bool as_json) {
  if (!info.ok()) return info.status();
  info->set_http_address(pageToOpen(info->http_address(), server));
  if (as_json) return printJson(*info);
  print(*info, strCat(info->http_address(), pageRemark(info->http_address(), server)));
  return absl::OkStatus();
}

absl::Status list(const ListOptions& options, const std::string& server, const Catalog& catalog) {
  const auto wants = [&](const char* what) {
    return options.what == what || options.what == "all";
  };
  if (wants("server")) {
    VIEWLOOM_RETURN_IF_ERROR(showServer(catalog.getServerInfo(), server, options.as_json));
  }
  if (wants("streams")) VIEWLOOM_RETURN_IF_ERROR(show(catalog.listStreams(), options.as_json));
  if (wants("displays")) VIEWLOOM_RETURN_IF_ERROR(show(catalog.listDisplays(), options.as_json));
  if (wants("presets")) VIEWLOOM_RETURN_IF_ERROR(show(catalog.listPresets(), options.as_json));
  return absl::OkStatus();
}

}  // namespace

RunCommand addListCommand(const usage::Command& app) {
  const auto options = std::make_shared<ListOptions>();
  app.footer(
      "Examples:\n"
      "  viewloom list                                    everything on the server of this "
      "machine\n"
      "  viewloom list presets                            names of devices for --preset\n"
      "  viewloom list streams --server 192.168.1.20:50051");
  app.add("what", options->what, "List to print: streams, displays, presets, server or all")
      .showDefault();
  for (const char* what : {"streams", "displays", "presets"}) {
    app.addAction(
           strCat("--", what), [options, what] { options->what = what; },
           strCat("The same as ", what))
        .excludes("what")
        .group("");
  }
  app.addFlag("--json", options->as_json, "Print the answers of the server as JSON");
  return [options](const CommonOptions& common) -> int {
    if (std::ranges::find(kLists, options->what) == kLists.end()) {
      std::fprintf(stderr, "viewloom list: %s\n", unknownList(options->what).c_str());
      return kExitUsage;
    }
    const absl::Status status = list(*options, common.server, Catalog(channelTo(common)));
    return status.ok() ? kExitDone : reportError(status, common);
  };
}

}  // namespace viewloom::cli
