// SPDX-License-Identifier: Apache-2.0
#include "web/watch_request.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <span>
#include <string_view>
#include <vector>

#include "absl/strings/str_join.h"
#include "base/nearest_name.h"
#include "base/str_cat.h"
#include "display/atlas_layout.h"
#include "display/named_display.h"
#include "web/rgbd_request.h"
#include "web/watch_parameters.h"

namespace viewloom {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;

constexpr std::array kQuiltParameters = {
    ParameterField{"stream", "stream"},
    ParameterField{"preset", "quilt.preset"},
    ParameterField{"columns", "quilt.columns"},
    ParameterField{"rows", "quilt.rows"},
    ParameterField{"width", "quilt.size.width"},
    ParameterField{"height", "quilt.size.height"},
    ParameterField{"aspect", "quilt.aspect"},
    ParameterField{"cone_deg", "quilt.view_cone_rad"},
    ParameterField{"cone_begin", "quilt.cone_begin"},
    ParameterField{"cone_end", "quilt.cone_end"},
    ParameterField{"focus_m", "quilt.focal_distance_m"},
    ParameterField{"focus_follow_s", "focus_following_s"},
    ParameterField{"fov_deg", "quilt.fov_y_rad"},
    ParameterField{"aperture_m", "effects.lens.aperture_radius_m"},
    ParameterField{"lens_focus_m", "effects.lens.focus_distance_m"},
    ParameterField{"effort", "effort"},
    ParameterField{"rate_hz", "effects.temporal.output_rate_hz"},
    ParameterField{"between", "effects.temporal.mode"},
    ParameterField{"reflections", "effects.reflection.bounces"},
    ParameterField{"quality", "jpeg_quality"},
    ParameterField{"chroma", "chroma"},
    ParameterField{"depth", "with_depth"},
};

// A panel behind microlenses: its preset gives the size, the lenses and the field of view.
constexpr std::array kIntegralParameters = {
    ParameterField{"stream", "stream"},
    ParameterField{"preset", "integral.preset"},
    ParameterField{"aperture_m", "effects.lens.aperture_radius_m"},
    ParameterField{"lens_focus_m", "effects.lens.focus_distance_m"},
    ParameterField{"effort", "effort"},
    ParameterField{"rate_hz", "effects.temporal.output_rate_hz"},
    ParameterField{"between", "effects.temporal.mode"},
    ParameterField{"reflections", "effects.reflection.bounces"},
    ParameterField{"quality", "jpeg_quality"},
    ParameterField{"chroma", "chroma"},
    ParameterField{"depth", "with_depth"},
};

enum class AskedKind : uint8_t { kQuilt, kIntegral, kRgbd };

// The kind that parameters ask for, by the name of a device or by "rgbd".
absl::StatusOr<AskedKind> askedKind(const QueryParameters& parameters) {
  if (parameters.contains("rgbd")) return AskedKind::kRgbd;
  const auto preset = parameters.find("preset");
  if (preset == parameters.end() || preset->second.empty()) return AskedKind::kQuilt;
  const absl::StatusOr<DisplayKind> named = namedDisplay(preset->second);
  VIEWLOOM_RETURN_IF_ERROR(named.status());
  if (std::holds_alternative<RgbdSpec>(*named)) return AskedKind::kRgbd;
  if (std::holds_alternative<IntegralSpec>(*named)) return AskedKind::kIntegral;
  return AskedKind::kQuilt;
}

std::span<const ParameterField> parametersOf(AskedKind kind) {
  switch (kind) {
    case AskedKind::kQuilt:
      return kQuiltParameters;
    case AskedKind::kIntegral:
      return kIntegralParameters;
    case AskedKind::kRgbd:
      break;
  }
  return rgbdParameters();
}

// The same refusal, told to somebody who wrote a parameter and not a field. Angles came in degrees:
// the sentence says that its range is in radians.
absl::Status namedByParameter(const absl::Status& status, std::span<const ParameterField> all) {
  const std::string field = fieldOf(status);
  for (const ParameterField& known : all) {
    if (field != known.field) continue;
    std::string problem(status.message());
    if (problem.starts_with(field + ": ")) problem.erase(0, field.size() + 2);
    if (field.ends_with("_rad")) problem += strCat(" radians");
    return fieldError(status.code(), known.parameter, problem);
  }
  return status;
}

// ", did you mean "portrait"?", or nothing.
std::string suggestion(std::string_view word, const std::vector<std::string>& names) {
  const std::string text = didYouMean(word, names);
  return text.empty() ? "" : strCat(", ", text);
}

absl::Status checkKnown(const QueryParameters& parameters, std::span<const ParameterField> all) {
  for (const auto& [name, value] : parameters) {
    bool known = false;
    for (const ParameterField& accepted : all) known |= name == accepted.parameter;
    if (known) continue;
    std::vector<std::string> names;
    for (const ParameterField& accepted : all) names.emplace_back(accepted.parameter);
    return invalidField(name, strCat("this display has no such parameter", suggestion(name, names),
                                     "; accepted are ", absl::StrJoin(names, ", ")));
  }
  return absl::OkStatus();
}

absl::StatusOr<QuiltSpec> readQuilt(const QueryParameters& parameters) {
  QuiltSpec quilt;
  const auto preset = parameters.find("preset");
  if (preset != parameters.end()) {
    quilt.preset = preset->second;
  } else if (!parameters.contains("columns") && !parameters.contains("rows")) {
    quilt.preset = "portrait";
  }
  double cone_deg = 0;
  double fov_deg = 0;
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "columns", quilt.columns));
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "rows", quilt.rows));
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "width", quilt.size_px.width));
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "height", quilt.size_px.height));
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "aspect", quilt.aspect));
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "focus_m", quilt.focal_distance_m));
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "cone_deg", cone_deg));
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "cone_begin", quilt.cone_begin));
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "cone_end", quilt.cone_end));
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "fov_deg", fov_deg));
  quilt.view_cone_rad = cone_deg * kRadPerDeg;
  quilt.fov_y_rad = fov_deg * kRadPerDeg;
  return quilt;
}

// Without a rate, an atlas a frame.
absl::Status readTemporal(const QueryParameters& parameters, DisplaySpec& display) {
  TemporalSpec temporal;
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "rate_hz", temporal.output_rate_hz));
  if (const auto between = parameters.find("between"); between != parameters.end()) {
    if (between->second != "predict" && between->second != "interpolate") {
      return invalidField(
          "between", strCat("got \"", between->second, "\", accepted are predict and interpolate"));
    }
    if (between->second == "interpolate") temporal.mode = TemporalMode::kInterpolate;
  }
  if (parameters.contains("rate_hz")) display.temporal = temporal;
  return absl::OkStatus();
}

// Colour next to the greys of a depth image shows in them where chroma is shared.
absl::StatusOr<EncodingSpec> readEncoding(const QueryParameters& parameters, bool is_rgbd) {
  EncodingSpec encoding;
  if (is_rgbd) encoding.chroma = Chroma::k444;
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "quality", encoding.jpeg_quality));
  if (const auto chroma = parameters.find("chroma"); chroma != parameters.end()) {
    if (chroma->second != "420" && chroma->second != "444") {
      return invalidField("chroma",
                          strCat("got \"", chroma->second, "\", accepted are 420 and 444"));
    }
    encoding.chroma = chroma->second == "444" ? Chroma::k444 : Chroma::k420;
  }
  if (const auto depth = parameters.find("depth"); depth != parameters.end()) {
    if (depth->second != "0" && depth->second != "1") {
      return invalidField("depth", strCat("got \"", depth->second, "\", accepted are 0 and 1"));
    }
    encoding.with_depth = depth->second == "1";
    encoding.planes = BandEncoding::kRaw;  // browsers have no zstd
  }
  VIEWLOOM_RETURN_IF_ERROR(validateEncodingSpec(encoding));
  return encoding;
}

absl::StatusOr<std::string> readStream(const QueryParameters& parameters,
                                       const StreamDirectory& streams) {
  const auto stream = parameters.find("stream");
  if (stream == parameters.end()) return invalidField("stream", "missing: the name of a stream");
  if (streams.exists(stream->second)) return stream->second;
  std::vector<std::string> names;
  for (const StreamEntry& entry : streams.list()) names.push_back(entry.name);
  return fieldError(absl::StatusCode::kNotFound, "stream", noSuchName(stream->second, names));
}

// A radius or "auto"; without one, everything is sharp.
absl::Status readLens(const QueryParameters& parameters, DisplaySpec& display) {
  const auto aperture = parameters.find("aperture_m");
  LensSpec lens;
  if (aperture != parameters.end() && aperture->second == "auto") {
    lens.has_automatic_aperture = true;
  } else {
    VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "aperture_m", lens.aperture_radius_m));
  }
  double focus_m = 0;
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "lens_focus_m", focus_m));
  if (parameters.contains("lens_focus_m")) lens.focus_distance_m = focus_m;
  if (aperture != parameters.end()) display.lens = lens;
  return absl::OkStatus();
}

absl::Status readEffort(const QueryParameters& parameters, DisplaySpec& display) {
  const auto effort = parameters.find("effort");
  if (effort == parameters.end() || effort->second == "balanced") return absl::OkStatus();
  if (effort->second == "draft") {
    display.quality = Quality::kDraft;
  } else if (effort->second == "best") {
    display.quality = Quality::kBest;
  } else {
    return invalidField(
        "effort", strCat("got \"", effort->second, "\", accepted are draft, balanced and best"));
  }
  return absl::OkStatus();
}

absl::StatusOr<DisplaySpec> readDisplay(const QueryParameters& parameters, AskedKind kind) {
  DisplaySpec display;
  if (kind == AskedKind::kRgbd) {
    absl::StatusOr<RgbdSpec> rgbd = readRgbd(parameters);
    VIEWLOOM_RETURN_IF_ERROR(rgbd.status());
    display.kind = *std::move(rgbd);
    return display;
  }
  if (kind == AskedKind::kIntegral) {
    display.kind = IntegralSpec{.preset = parameters.at("preset")};
  } else {
    absl::StatusOr<QuiltSpec> quilt = readQuilt(parameters);
    VIEWLOOM_RETURN_IF_ERROR(quilt.status());
    display.kind = *std::move(quilt);
  }
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "focus_follow_s", display.focus_following_s));
  VIEWLOOM_RETURN_IF_ERROR(readLens(parameters, display));
  VIEWLOOM_RETURN_IF_ERROR(readEffort(parameters, display));
  VIEWLOOM_RETURN_IF_ERROR(readTemporal(parameters, display));
  if (parameters.contains("reflections")) {
    uint32_t& bounce_count = display.reflection.emplace().bounce_count;
    VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "reflections", bounce_count));
    if (bounce_count == 0) {
      return invalidField("reflections", "got 0, accepted are 1..4 bounces; without it, none");
    }
  }
  return display;
}

}  // namespace

absl::StatusOr<WatchRequest> parseWatchRequest(const QueryParameters& parameters,
                                               const StreamDirectory& streams) {
  const absl::StatusOr<AskedKind> kind = askedKind(parameters);
  VIEWLOOM_RETURN_IF_ERROR(kind.status());
  const std::span<const ParameterField> all = parametersOf(*kind);
  VIEWLOOM_RETURN_IF_ERROR(checkKnown(parameters, all));
  const absl::StatusOr<DisplaySpec> display = readDisplay(parameters, *kind);
  VIEWLOOM_RETURN_IF_ERROR(display.status());
  absl::StatusOr<DisplaySpec> completed = completeDisplaySpec(*display);
  VIEWLOOM_RETURN_IF_ERROR(namedByParameter(completed.status(), all));
  const absl::StatusOr<EncodingSpec> encoding = readEncoding(parameters, *kind == AskedKind::kRgbd);
  VIEWLOOM_RETURN_IF_ERROR(namedByParameter(encoding.status(), all));
  absl::StatusOr<std::string> stream = readStream(parameters, streams);
  VIEWLOOM_RETURN_IF_ERROR(stream.status());
  return WatchRequest{*std::move(stream), *std::move(completed), *encoding};
}

absl::StatusOr<std::string> quiltSuffix(const DisplaySpec& display) {
  if (!std::holds_alternative<QuiltSpec>(display.kind)) return std::string();
  // The suffix does not depend on the stream: any camera serves.
  const StreamDefaults any_stream{.source_intrinsics = {}, .source_size_px = {1, 1}};
  absl::StatusOr<AtlasLayout> layout = makeAtlasLayout(display, any_stream);
  VIEWLOOM_RETURN_IF_ERROR(layout.status());
  return layout->suffix;
}

}  // namespace viewloom
