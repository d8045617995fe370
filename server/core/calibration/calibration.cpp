// SPDX-License-Identifier: Apache-2.0
#include "calibration/calibration.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_nesting.h"
#include "base/str_cat.h"
#include "calibration/calibration_keys.h"
#include "calibration/make_lenticular.h"

namespace viewloom {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr double kSideMax_px = 16384;
constexpr double kOffsetMax_px = 16;
// Lenses that lie flatter than this have no width along a row.
constexpr double kSlopeMin = 0.01;
constexpr double kSlopeMax = 1e6;

// Deepest nesting that is read; real files have three levels. What walks a value in depth would
// overflow the stack of a thread with the nesting that fits into a file.
constexpr size_t kDepthMax = 16;

absl::StatusOr<json> parseShallow(std::string_view text) {
  if (!isNestedDeeply(text, kDepthMax)) return json::parse(text);
  return refuseKey("calibration", strCat("nests lists or objects deeper than ", kDepthMax,
                                         "; accepted are up to ", kDepthMax, " levels"));
}

absl::StatusOr<json> parseObject(std::string_view text) {
  if (text.size() > kCalibrationBytesMax) {
    return refuseKey("calibration", strCat("has ", text.size(), " bytes; accepted are up to ",
                                           kCalibrationBytesMax));
  }
  try {
    absl::StatusOr<json> value = parseShallow(text);
    if (value.ok() && value->is_string()) {
      const std::string inner = value->get<std::string>();  // the value goes while it is parsed
      value = parseShallow(inner);
    }
    if (!value.ok() || value->is_object()) return value;
    return refuseKey("calibration", strCat("is ", describeJson(*value),
                                           "; accepted is one JSON object with pitch, slope, "
                                           "center, DPI, screenW and screenH"));
  } catch (const json::exception& error) {
    return refuseKey("calibration", strCat("is no JSON: ", error.what()));
  }
}

// Reads number after number, up to the first that is refused.
class KeyReader {
 public:
  explicit KeyReader(const json& object) : object_(object) {}

  double number(const NumberKey& key) {
    if (!status_.ok()) return 0;
    const absl::StatusOr<double> value = readNumber(object_, key);
    if (!value.ok()) status_ = value.status();
    return value.value_or(0);
  }
  uint32_t whole(NumberKey key) {
    key.is_whole = true;
    return static_cast<uint32_t>(number(key));
  }
  // On from a half, as players of the device read it.
  bool flag(const char* name, bool fallback) {
    return number({name, -1e6, 1e6, fallback ? 1.0 : 0.0}) >= 0.5;
  }
  std::string text(const char* name) {
    if (!status_.ok()) return "";
    absl::StatusOr<std::string> value = readText(object_, name);
    if (!value.ok()) status_ = value.status();
    return value.value_or("");
  }
  const absl::Status& status() const { return status_; }

 private:
  const json& object_;
  absl::Status status_;
};

absl::StatusOr<SubpixelCell> readCell(const json& object) {
  KeyReader keys(object);
  const auto offset = [&](const char* x, const char* y) {
    const double x_px = keys.number({x, -kOffsetMax_px, kOffsetMax_px});
    return SubpixelOffset{x_px, keys.number({y, -kOffsetMax_px, kOffsetMax_px})};
  };
  SubpixelCell cell;
  cell.red = offset("ROffsetX", "ROffsetY");
  cell.green = offset("GOffsetX", "GOffsetY");
  cell.blue = offset("BOffsetX", "BOffsetY");
  if (!keys.status().ok()) return keys.status();
  return cell;
}

absl::StatusOr<std::vector<SubpixelCell>> readCells(const json& object) {
  std::vector<SubpixelCell> cells;
  const auto found = object.find("subpixelCells");
  if (found == object.end()) return cells;
  if (!found->is_array() || found->size() > abi::kCellCountMax) {
    return refuseKey("subpixelCells",
                     strCat("is ", describeJson(*found), "; accepted is a list of up to ",
                            abi::kCellCountMax, " cells: no pattern has more"));
  }
  for (size_t i = 0; i < found->size(); ++i) {
    const std::string place = strCat("subpixelCells[", i, "]");
    const json& element = (*found)[i];
    if (!element.is_object()) {
      return refuseKey(place, strCat("is ", describeJson(element),
                                     "; accepted is an object with ROffsetX .. BOffsetY"));
    }
    const absl::StatusOr<SubpixelCell> cell = readCell(element);
    if (!cell.ok()) return withFieldPrefix(cell.status(), place);
    cells.push_back(*cell);
  }
  return cells;
}

absl::Status checkLenses(const Calibration& calibration) {
  if (calibration.pitch == 0) {
    return refuseKey("pitch", "is 0; accepted is a number other than 0, as 52.6");
  }
  if (std::abs(calibration.slope) < kSlopeMin) {
    return refuseKey("slope", strCat("is ", calibration.slope, "; accepted is a number of ",
                                     kSlopeMin, "..", kSlopeMax, " in size, as -7.2"));
  }
  const double lenses = std::abs(lensCount(calibration));
  if (lenses <= calibration.screen_px.width) return absl::OkStatus();
  return refuseKey(
      "pitch", strCat("is ", calibration.pitch, ", which with DPI ", calibration.dpi, " and slope ",
                      calibration.slope, " makes ", lenses, " lenses across ",
                      calibration.screen_px.width, " px; accepted is up to one a px"));
}

ordered_json wrapped(double value) {
  return ordered_json::object({{"value", value}});
}

}  // namespace

absl::StatusOr<Calibration> parseCalibration(std::string_view text) {
  const absl::StatusOr<json> object = parseObject(text);
  if (!object.ok()) return object.status();
  KeyReader keys(*object);
  Calibration calibration;
  calibration.pitch = keys.number({"pitch", -1e4, 1e4});
  calibration.slope = keys.number({"slope", -kSlopeMax, kSlopeMax});
  calibration.center = keys.number({"center", -1e4, 1e4});
  calibration.view_cone_deg = keys.number({"viewCone", 1, 179, 40.0});
  calibration.vertical_angle = keys.number({"verticalAngle", -1e6, 1e6, 0.0});
  calibration.dpi = keys.number({"DPI", 1, 1e5});
  calibration.screen_px.width = keys.whole({"screenW", 1, kSideMax_px});
  calibration.screen_px.height = keys.whole({"screenH", 1, kSideMax_px});
  calibration.inv_view = keys.flag("invView", true);
  calibration.flip_x = keys.flag("flipImageX", false);
  calibration.flip_y = keys.flag("flipImageY", false);
  calibration.flip_subpixels = keys.flag("flipSubp", false);
  const bool is_lower = object->contains("cellPatternMode") && !object->contains("CellPatternMode");
  const char* mode = is_lower ? "cellPatternMode" : "CellPatternMode";
  calibration.cell_pattern_mode = keys.whole({mode, abi::kCellsAlike, abi::kCellsByRow, 0.0});
  calibration.serial = keys.text("serial");
  calibration.config_version = keys.text("configVersion");
  VIEWLOOM_RETURN_IF_ERROR(keys.status());
  absl::StatusOr<std::vector<SubpixelCell>> cells = readCells(*object);
  if (!cells.ok()) return cells.status();
  calibration.cells = *std::move(cells);
  VIEWLOOM_RETURN_IF_ERROR(checkLenses(calibration));
  return calibration;
}

std::string writeCalibration(const Calibration& calibration) {
  ordered_json cells = ordered_json::array();
  for (const SubpixelCell& cell : calibration.cells) {
    cells.push_back({{"ROffsetX", cell.red.x_px},
                     {"ROffsetY", cell.red.y_px},
                     {"GOffsetX", cell.green.x_px},
                     {"GOffsetY", cell.green.y_px},
                     {"BOffsetX", cell.blue.x_px},
                     {"BOffsetY", cell.blue.y_px}});
  }
  const ordered_json file = {
      {"configVersion", calibration.config_version},
      {"serial", calibration.serial},
      {"pitch", wrapped(calibration.pitch)},
      {"slope", wrapped(calibration.slope)},
      {"center", wrapped(calibration.center)},
      {"viewCone", wrapped(calibration.view_cone_deg)},
      {"invView", wrapped(calibration.inv_view)},
      {"verticalAngle", wrapped(calibration.vertical_angle)},
      {"DPI", wrapped(calibration.dpi)},
      {"screenW", wrapped(calibration.screen_px.width)},
      {"screenH", wrapped(calibration.screen_px.height)},
      {"flipImageX", wrapped(calibration.flip_x)},
      {"flipImageY", wrapped(calibration.flip_y)},
      {"flipSubp", wrapped(calibration.flip_subpixels)},
      {"CellPatternMode", wrapped(calibration.cell_pattern_mode)},
      {"subpixelCells", cells},
  };
  return file.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace viewloom
