// SPDX-License-Identifier: Apache-2.0
#include "unit/calibration/device_files.h"

#include "base/check.h"

namespace viewloom {

const std::string_view kPortraitFile =
    R"({"configVersion":"3.0","serial":"LKG-PORT-","pitch":{"value":52.594383239746094},)"
    R"("slope":{"value":-7.21152925491333},"center":{"value":0.40277382731437683},)"
    R"("viewCone":{"value":40},"invView":{"value":1},"verticalAngle":{"value":0},)"
    R"("DPI":{"value":324},"screenW":{"value":1536},"screenH":{"value":2048},)"
    R"("flipImageX":{"value":0},"flipImageY":{"value":0},"flipSubp":{"value":0},)"
    R"("subpixelCells":[],"CellPatternMode":{"value":0}})";

const std::string_view kThirdGenerationFile =
    R"({"configVersion":"3.0","serial":"LKG-J00332","pitch":{"value":44.75058319896644},)"
    R"("slope":{"value":-6.874565686767793},"center":{"value":0.16935753461833172},)"
    R"("viewCone":{"value":50.0},"DPI":{"value":283.0},"screenW":{"value":3840.0},)"
    R"("screenH":{"value":2160.0},"flipImageX":{"value":0.0},"CellPatternMode":{"value":2.0},)"
    R"("subpixelCells":[{"ROffsetX":-0.31,"ROffsetY":0.25,"GOffsetX":0.28,"GOffsetY":0.25,)"
    R"("BOffsetX":0.0,"BOffsetY":-0.25},{"ROffsetX":-0.31,"ROffsetY":-0.25,"GOffsetX":0.28,)"
    R"("GOffsetY":-0.25,"BOffsetX":0.0,"BOffsetY":0.25}]})";

std::string edited(std::string_view file, std::string_view from, std::string_view to) {
  std::string text(file);
  const size_t at = text.find(from);
  VIEWLOOM_CHECK(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace viewloom
