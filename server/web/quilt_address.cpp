// SPDX-License-Identifier: Apache-2.0
#include "web/quilt_address.h"

#include <charconv>
#include <optional>

#include "access/operations.h"
#include "base/str_cat.h"
#include "web/asked_display.h"

namespace viewloom {
namespace {

constexpr std::string_view kSuffixBegin = "_qs";

// An address taken apart: ROOT STREAM/PRESET, with EXTENSION or without; ROOT STREAM_qs8x6a0.75
// EXTENSION; or ROOT STREAM EXTENSION?display=JSON.
struct AddressParts {
  QueryParameters parameters;  // of the URL and of its path
  std::string suffix;          // of the second form
  std::string extension;
};

struct QuiltShape {
  uint32_t columns = 0;
  uint32_t rows = 0;
  double aspect = 0;
};

template <typename Number>
bool takeNumber(std::string_view& text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  text.remove_prefix(size_t(end - text.data()));
  return error == std::errc();
}

bool takeLetter(std::string_view& text, char letter) {
  if (!text.starts_with(letter)) return false;
  text.remove_prefix(1);
  return true;
}

// "_qs8x6a0.75"
std::optional<QuiltShape> readSuffix(std::string_view suffix) {
  QuiltShape shape;
  suffix.remove_prefix(kSuffixBegin.size());
  const bool is_whole = takeNumber(suffix, shape.columns) && takeLetter(suffix, 'x') &&
                        takeNumber(suffix, shape.rows) && takeLetter(suffix, 'a') &&
                        takeNumber(suffix, shape.aspect) && suffix.empty();
  if (!is_whole) return std::nullopt;
  return shape;
}

absl::StatusOr<AddressParts> takeApart(const Url& url, const QuiltAddressForm& form) {
  std::string_view rest = std::string_view(url.path).substr(form.root.size());
  AddressParts parts{
      .parameters = url.parameters, .suffix = "", .extension = form.extensions.front()};
  bool has_extension = false;
  for (const std::string& extension : form.extensions) {
    if (has_extension || !rest.ends_with(extension)) continue;
    has_extension = true;
    parts.extension = extension;
    rest.remove_suffix(extension.size());
  }
  const size_t slash = rest.find('/');
  const size_t suffix = rest.rfind(kSuffixBegin);
  if (slash != std::string_view::npos) {
    parts.parameters["preset"] = rest.substr(slash + 1);
    rest = rest.substr(0, slash);
  } else if (has_extension && suffix != std::string_view::npos &&
             (url.parameters.contains("display") || url.parameters.contains("preset") ||
              readSuffix(rest.substr(suffix)))) {
    parts.suffix = rest.substr(suffix);
    rest = rest.substr(0, suffix);
  } else if (!has_extension || !url.parameters.contains("display")) {
    return fieldError(
        absl::StatusCode::kNotFound, "url",
        strCat("the address names no display; accepted is ", form.root, "STREAM/PRESET, ",
               form.root, "STREAM_qs8x6a0.75", form.extensions.front(), " or ", form.root, "STREAM",
               form.extensions.front(), "?display=JSON"));
  }
  parts.parameters["stream"] = rest;
  return parts;
}

// A suffix says how the views of a quilt lie, where nothing else says what the display is.
absl::StatusOr<AskedDisplay> askedBy(const AddressParts& parts) {
  const bool is_named = parts.parameters.contains("display") || parts.parameters.contains("preset");
  absl::StatusOr<AskedDisplay> asked = askedDisplay(parts.parameters);
  if (!asked.ok() || is_named || parts.suffix.empty()) return asked;
  const QuiltShape shape = readSuffix(parts.suffix).value();
  v1::QuiltDisplay& quilt = *asked->display.mutable_quilt();  // has the size, if one came
  quilt.clear_preset();
  quilt.set_columns(shape.columns);
  quilt.set_rows(shape.rows);
  quilt.set_aspect(shape.aspect);
  return asked;
}

absl::StatusOr<WatchRequest> requestOf(const AddressParts& parts) {
  const absl::StatusOr<AskedDisplay> asked = askedBy(parts);
  VIEWLOOM_RETURN_IF_ERROR(asked.status());
  absl::StatusOr<WatchRequest> request = makeWatchRequest(*asked);
  if (!request.ok()) return inParameters(request.status(), parts.parameters);
  VIEWLOOM_RETURN_IF_ERROR(checkUntracked(request->display));
  if (request->encoding.color == BandEncoding::kJpeg) return request;
  return invalidField("encoding.color",
                      "stills, motion JPEG and live videos are made of JPEG; accepted here is "
                      "BAND_ENCODING_JPEG");
}

// "?width=800&height=600", or nothing.
std::string queryText(const QueryParameters& parameters) {
  const std::string query = queryString(parameters);
  return query.empty() ? "" : strCat("?", query);
}

}  // namespace

QuiltAddressForm stillForm() {
  return {.root = std::string(kStills), .extensions = {".jpg", std::string(kLayoutExtension)}};
}

QuiltAddressForm streamForm() {
  return {.root = std::string(kPlayers), .extensions = {".mjpg", std::string(kMovieExtension)}};
}

absl::StatusOr<QuiltAddress> parseQuiltAddress(const Url& url, const QuiltAddressForm& form) {
  const absl::StatusOr<AddressParts> parts = takeApart(url, form);
  VIEWLOOM_RETURN_IF_ERROR(parts.status());
  absl::StatusOr<WatchRequest> request = requestOf(*parts);
  VIEWLOOM_RETURN_IF_ERROR(request.status());
  const absl::StatusOr<std::string> suffix = quiltSuffix(request->display);
  VIEWLOOM_RETURN_IF_ERROR(suffix.status());
  QuiltAddress address{.request = *std::move(request),
                       .extension = parts->extension,
                       .file_name = "",
                       .redirect = ""};
  QueryParameters parameters = parts->parameters;
  parameters.erase("stream");
  const std::string stream = percentEncoded(address.request.stream);
  if (suffix->empty()) {
    // Players read the suffix of a quilt: other displays are found by their names alone.
    const bool is_named = parameters.contains("preset");
    const std::string name =
        is_named ? parameters["preset"]
                 : std::visit([](const auto& kind) { return std::string(kind.kName); },
                              address.request.display.kind);
    address.file_name = strCat(address.request.stream, "_", name, address.extension);
    if (parts->suffix.empty()) return address;
    parameters.erase("preset");
    address.redirect = strCat(form.root, stream, is_named ? "/" + percentEncoded(name) : "",
                              address.extension, queryText(parameters));
    return address;
  }
  const std::string layout = strCat(*suffix, address.extension);
  address.file_name = address.request.stream + layout;
  if (*suffix == parts->suffix) return address;
  address.redirect = strCat(form.root, stream, layout, queryText(parameters));
  return address;
}

}  // namespace viewloom
