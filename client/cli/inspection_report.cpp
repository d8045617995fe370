// SPDX-License-Identifier: Apache-2.0
#include "cli/inspection_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/printable.h"
#include "base/str_cat.h"
#include "cli/file_frames.h"
#include "cli/plane_text.h"
#include "cli/status_line.h"
#include "files/container.h"
#include "files/exr_description.h"
#include "photos/photo.h"

namespace viewloom::cli {
namespace {

using Json = nlohmann::json;

std::string partText(const std::string& exr_type) {
  const std::string prefix = exr_type.starts_with("deep") ? "deep " : "";
  return prefix + (exr_type.starts_with("tile") || exr_type == "deeptile" ? "tiles" : "scan lines");
}

// Angle that an image around the axis covers.
double fovDegrees(double focal_px, uint32_t side_px) {
  return 2 * std::atan(0.5 * side_px / focal_px) * 180 / std::numbers::pi;
}

std::string cameraText(const v1::Camera& camera, const v1::SizePx& size, bool is_assumed) {
  const v1::Vector3& at = camera.pose().position();
  std::string text = strCat("at ", at.x(), " ", at.y(), " ", at.z(), " m");
  if (camera.has_intrinsics()) {
    const v1::Intrinsics& i = camera.intrinsics();
    text = strCat(text, ", ", formatNumber(fovDegrees(i.focal_x_px(), size.width()), 1), " x ",
                  formatNumber(fovDegrees(i.focal_y_px(), size.height()), 1),
                  " degrees, focal length ", formatNumber(i.focal_x_px(), 1), " px, axis at ",
                  formatNumber(i.principal_x_px(), 1), ", ", formatNumber(i.principal_y_px(), 1));
  }
  return is_assumed ? strCat(text, " (assumed: give --fov or --focal-px)") : text;
}

std::string percentText(uint64_t count, uint64_t of) {
  return strCat(formatNumber(100.0 * double(count) / double(std::max<uint64_t>(of, 1)), 1), " %");
}

void addLine(std::string& text, const std::string& what, const std::string& line) {
  const std::string gap(what.size() < 10 ? 10 - what.size() : 1, ' ');
  text += "  " + what + gap + printable(line) + "\n";
}

void addLayer(std::string& text, const inspect::LayerInspection& layer) {
  addLine(text, "colour",
          strCat(sizeText(layer.color.size()), " px, ", sampleText(layer.color), ", ",
                 transferOf(layer.color), ", ", primariesOf(layer.color), ", alpha ",
                 alphaOf(layer.color)));
  addLine(text, "depth",
          strCat(sizeText(layer.depth.size()), " px, ", sampleText(layer.depth), ": ",
                 depthText(layer.depth)));
  const inspect::DepthSamples& samples = layer.samples;
  const inspect::DepthMeasures& measures = layer.measures;
  if (samples.surface_count > 0) {
    addLine(text, "range",
            strCat(1 / measures.inv_z_max, " .. ", 1 / measures.inv_z_min, " m, median ",
                   1 / measures.inv_z_median, " m"));
    addLine(text, "measured",
            strCat("step ", measures.step, " 1/m, noise ", measures.noise_sigma, " 1/m"));
  }
  const uint64_t all = samples.sampleCount();
  addLine(text, "samples",
          strCat(percentText(samples.surface_count, all), " surface, ",
                 percentText(samples.sky_count, all), " infinitely far, ",
                 percentText(samples.invalid_count, all), " invalid, ",
                 percentText(samples.bad_count, all), " NaN or negative"));
  for (const inspect::Suspicion& suspicion : layer.suspicions) {
    addLine(text, "warning", warningText(suspicion));
  }
}

Json layerJson(const inspect::LayerInspection& layer) {
  const inspect::DepthSamples& samples = layer.samples;
  const inspect::DepthMeasures& measures = layer.measures;
  const v1::DepthFormat& format = layer.depth.depth();
  Json depth = {{"width_px", samples.width_px},
                {"height_px", samples.height_px},
                {"encoding", encodingOf(layer.depth)},
                {"meaning", meaningOf(layer.depth)},
                {"scale", scaleOf(format)},
                {"offset", format.offset()},
                {"surface_count", samples.surface_count},
                {"sky_count", samples.sky_count},
                {"invalid_count", samples.invalid_count},
                {"bad_count", samples.bad_count},
                {"step_per_m", measures.step},
                {"noise_sigma_per_m", measures.noise_sigma}};
  if (format.meaning() == v1::DEPTH_MEANING_WINDOW) {
    depth["near_m"] = format.near_z_m();
    // JSON has no infinity.
    depth["far_m"] = std::isinf(format.far_z_m()) ? Json("inf") : Json(format.far_z_m());
  }
  if (format.has_invalid_value()) {
    depth["invalid_value"] = format.invalid_value();
    depth["invalid_is_far"] = format.invalid_is_far();
  }
  if (samples.surface_count > 0) {
    depth["min_m"] = 1 / measures.inv_z_max;
    depth["median_m"] = 1 / measures.inv_z_median;
    depth["max_m"] = 1 / measures.inv_z_min;
  }
  Json warnings = Json::array();
  for (const inspect::Suspicion& suspicion : layer.suspicions) {
    warnings.push_back(
        {{"kind", suspicion.kind}, {"sentence", suspicion.sentence}, {"remedy", suspicion.remedy}});
  }
  return {{"color",
           {{"width_px", layer.color.size().width()},
            {"height_px", layer.color.size().height()},
            {"encoding", encodingOf(layer.color)},
            {"transfer", transferOf(layer.color)},
            {"primaries", primariesOf(layer.color)},
            {"alpha", alphaOf(layer.color)}}},
          {"depth", depth},
          {"warnings", warnings}};
}

Json cameraJson(const v1::Camera& camera, bool is_assumed) {
  const v1::Vector3& at = camera.pose().position();
  const v1::Quaternion& turn = camera.pose().orientation();
  Json json = {{"position_m", {at.x(), at.y(), at.z()}},
               {"orientation_xyzw", {turn.x(), turn.y(), turn.z(), turn.w()}},
               {"is_assumed", is_assumed}};
  if (camera.has_intrinsics()) {
    const v1::Intrinsics& i = camera.intrinsics();
    json["focal_px"] = {i.focal_x_px(), i.focal_y_px()};
    json["principal_px"] = {i.principal_x_px(), i.principal_y_px()};
  }
  return json;
}

std::string kindOf(const InspectedFile& inspected) {
  if (!inspected.loaded.frame.deep.empty()) return inspected.loaded.how ? "deep" : "manifest";
  return inspected.loaded.how ? nameOf(inspected.loaded.how->kind) : "manifest";
}

absl::StatusOr<std::string> describePhoto(const std::string& file) {
  const absl::StatusOr<photos::Photo> photo = photos::Photo::open(file);
  if (!photo.ok()) return photo.status();
  const photos::PhotoDescription& its = photo->description();
  std::string text = strCat(files::nameOf(files::containerOf(file)), ", ", its.width_px, "x",
                            its.height_px, " px");
  if (its.depth) {
    text = strCat(text, "; depth ", its.depth->width_px, "x", its.depth->height_px,
                  " px: ", its.depth->type);
  }
  for (const std::string& type : its.other_types) text = strCat(text, "; ", type);
  return text;
}

}  // namespace

absl::StatusOr<std::string> describeFormat(const std::string& file) {
  if (photos::isPhoto(file)) return describePhoto(file);
  if (files::hasExtension(file, ".json")) return "manifest (JSON)";
  if (!files::isExr(file)) {
    VIEWLOOM_RETURN_IF_ERROR(files::checkPictureFile(file));
    return files::nameOf(files::containerOf(file));
  }
  const absl::StatusOr<files::ExrDescription> description = files::describeExr(file);
  if (!description.ok()) return description.status();
  const size_t part_count = description->parts.size();
  std::string text = strCat("OpenEXR, ", part_count, part_count == 1 ? " part" : " parts");
  for (const files::ExrDescribedPart& part : description->parts) {
    text = strCat(text, "; ", part.name.empty() ? "" : part.name + ": ", partText(part.type), " ",
                  part.width_px, "x", part.height_px, " px:");
    for (const files::ExrDescribedChannel& channel : part.channels) {
      text = strCat(text, " ", channel.name, " (", channel.type, ")");
    }
  }
  return text;
}

std::string warningText(const inspect::Suspicion& suspicion) {
  return strCat(suspicion.kind, ": ", suspicion.sentence,
                suspicion.remedy.empty() ? "" : "; " + suspicion.remedy);
}

std::string reportText(const InspectedFile& inspected) {
  std::string text = printable(inspected.file) + "\n";
  addLine(text, "file", inspected.format);
  const bool has_kind = inspected.loaded.how && inspected.loaded.frame.deep.empty();
  addLine(text, "read as", kindOf(inspected) + (has_kind ? " (--input)" : ""));
  if (inspected.loaded.how) {
    for (const std::string& note : inspected.loaded.how->notes) addLine(text, "", note);
  }
  for (const files::DeepReport& deep : inspected.loaded.frame.deep) {
    addLine(text, "", noteOf(deep));
  }
  for (size_t source = 0; source < inspected.sources.size(); ++source) {
    const inspect::SourceInspection& its = inspected.sources[source];
    if (inspected.sources.size() > 1) addLine(text, "source", strCat(source));
    addLine(text, "camera",
            cameraText(its.camera, its.layers.front().depth.size(), inspected.camera_is_assumed));
    for (size_t layer = 0; layer < its.layers.size(); ++layer) {
      if (its.layers.size() > 1) addLine(text, "layer", strCat(layer));
      addLayer(text, its.layers[layer]);
    }
  }
  if (inspected.need) {
    addLine(text, inspected.need->outside.empty() ? "display" : "warning",
            needText(*inspected.need));
  }
  return text;
}

Json reportJson(const InspectedFile& inspected) {
  Json json = {{"file", inspected.file},
               {"format", inspected.format},
               {"input", kindOf(inspected)},
               {"notes", Json::array()},
               {"sources", Json::array()}};
  if (inspected.loaded.how) json["notes"] = inspected.loaded.how->notes;
  for (const inspect::SourceInspection& source : inspected.sources) {
    Json layers = Json::array();
    for (const inspect::LayerInspection& layer : source.layers) layers.push_back(layerJson(layer));
    json["sources"].push_back(
        {{"camera", cameraJson(source.camera, inspected.camera_is_assumed)}, {"layers", layers}});
  }
  if (inspected.need) json["display"] = needJson(*inspected.need);
  return json;
}

std::string jsonText(const Json& json) {
  return json.dump(2, ' ', true, Json::error_handler_t::replace);
}

}  // namespace viewloom::cli
