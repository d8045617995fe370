// SPDX-License-Identifier: Apache-2.0
#include "web/watch_request.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "display/atlas_layout.h"

namespace viewloom {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;

// Parameters, and the fields of the API that the checks of displays and encodings name.
struct ParameterField {
  const char* parameter;
  const char* field;
};
constexpr std::array kParameters = {
    ParameterField{"stream", "stream"},
    ParameterField{"preset", "quilt.preset"},
    ParameterField{"columns", "quilt.columns"},
    ParameterField{"rows", "quilt.rows"},
    ParameterField{"width", "quilt.size.width"},
    ParameterField{"height", "quilt.size.height"},
    ParameterField{"aspect", "quilt.aspect"},
    ParameterField{"cone_deg", "quilt.view_cone_rad"},
    ParameterField{"focus_m", "quilt.focal_distance_m"},
    ParameterField{"focus_follow_s", "focus_following_s"},
    ParameterField{"fov_deg", "quilt.fov_y_rad"},
    ParameterField{"reflections", "effects.reflection.bounces"},
    ParameterField{"quality", "jpeg_quality"},
    ParameterField{"chroma", "chroma"},
    ParameterField{"depth", "with_depth"},
};

// The same refusal, told to somebody who wrote a parameter and not a field. Angles came in degrees:
// the sentence says that its range is in radians.
absl::Status namedByParameter(const absl::Status& status) {
  const std::string field = fieldOf(status);
  for (const ParameterField& known : kParameters) {
    if (field != known.field) continue;
    std::string problem(status.message());
    if (problem.starts_with(field + ": ")) problem.erase(0, field.size() + 2);
    if (field.ends_with("_rad")) absl::StrAppend(&problem, " radians");
    return fieldError(status.code(), known.parameter, problem);
  }
  return status;
}

absl::Status checkKnown(const QueryParameters& parameters) {
  for (const auto& [name, value] : parameters) {
    bool known = false;
    for (const ParameterField& accepted : kParameters) known |= name == accepted.parameter;
    if (known) continue;
    const auto append = [](std::string* out, const ParameterField& accepted) {
      out->append(accepted.parameter);
    };
    return invalidField(name, absl::StrCat("there is no such parameter, accepted are ",
                                           absl::StrJoin(kParameters, ", ", append)));
  }
  return absl::OkStatus();
}

// Leaves `value` alone when the parameter is not given.
template <typename Number>
absl::Status readNumber(const QueryParameters& parameters, const char* name, Number& value) {
  const auto found = parameters.find(name);
  if (found == parameters.end()) return absl::OkStatus();
  const std::string& text = found->second;
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (!whole || !std::isfinite(static_cast<double>(number))) {
    return invalidField(name, absl::StrCat("got \"", text, "\", accepted is a ",
                                           std::is_integral_v<Number> ? "whole number" : "number"));
  }
  value = number;
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
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "fov_deg", fov_deg));
  quilt.view_cone_rad = cone_deg * kRadPerDeg;
  quilt.fov_y_rad = fov_deg * kRadPerDeg;
  return quilt;
}

absl::StatusOr<EncodingSpec> readEncoding(const QueryParameters& parameters) {
  EncodingSpec encoding;
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "quality", encoding.jpeg_quality));
  if (const auto chroma = parameters.find("chroma"); chroma != parameters.end()) {
    if (chroma->second != "420" && chroma->second != "444") {
      return invalidField("chroma",
                          absl::StrCat("got \"", chroma->second, "\", accepted are 420 and 444"));
    }
    encoding.chroma = chroma->second == "444" ? Chroma::k444 : Chroma::k420;
  }
  if (const auto depth = parameters.find("depth"); depth != parameters.end()) {
    if (depth->second != "0" && depth->second != "1") {
      return invalidField("depth",
                          absl::StrCat("got \"", depth->second, "\", accepted are 0 and 1"));
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
  std::string existing;
  for (const StreamEntry& entry : streams.list()) {
    absl::StrAppend(&existing, existing.empty() ? "there are " : ", ", entry.name);
  }
  return fieldError(absl::StatusCode::kNotFound, "stream",
                    absl::StrCat("there is no \"", stream->second, "\"; ",
                                 existing.empty() ? "there are none yet" : existing));
}

}  // namespace

absl::StatusOr<WatchRequest> parseWatchRequest(const QueryParameters& parameters,
                                               const StreamDirectory& streams) {
  VIEWLOOM_RETURN_IF_ERROR(checkKnown(parameters));
  const absl::StatusOr<QuiltSpec> quilt = readQuilt(parameters);
  VIEWLOOM_RETURN_IF_ERROR(quilt.status());
  DisplaySpec display;
  display.kind = *quilt;
  VIEWLOOM_RETURN_IF_ERROR(readNumber(parameters, "focus_follow_s", display.focus_following_s));
  if (parameters.contains("reflections")) {
    display.reflection.emplace();
    VIEWLOOM_RETURN_IF_ERROR(
        readNumber(parameters, "reflections", display.reflection->bounce_count));
  }
  absl::StatusOr<DisplaySpec> completed = completeDisplaySpec(display);
  VIEWLOOM_RETURN_IF_ERROR(namedByParameter(completed.status()));
  const absl::StatusOr<EncodingSpec> encoding = readEncoding(parameters);
  VIEWLOOM_RETURN_IF_ERROR(namedByParameter(encoding.status()));
  absl::StatusOr<std::string> stream = readStream(parameters, streams);
  VIEWLOOM_RETURN_IF_ERROR(stream.status());
  return WatchRequest{*std::move(stream), *std::move(completed), *encoding};
}

absl::StatusOr<std::string> quiltSuffix(const DisplaySpec& display) {
  // The suffix does not depend on the stream: any camera serves.
  const StreamDefaults any_stream{.source_intrinsics = {}, .source_size_px = {1, 1}};
  absl::StatusOr<AtlasLayout> layout = makeAtlasLayout(display, any_stream);
  VIEWLOOM_RETURN_IF_ERROR(layout.status());
  return layout->suffix;
}

}  // namespace viewloom
