// SPDX-License-Identifier: Apache-2.0
#include "web/quilt_address.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr std::string_view kSuffixBegin = "_qs";

// An address taken apart: ROOT STREAM/PRESET, with EXTENSION or without, or ROOT STREAM_qs8x6a0.75
// EXTENSION.
struct AddressParts {
  QueryParameters parameters;  // of the URL and of its path
  std::string suffix;          // empty in the first form
  std::string extension;
};

// "_qs8x6a0.75" → columns, rows, aspect; whether they are numbers is for others to check.
bool readSuffix(std::string_view suffix, QueryParameters& parameters) {
  const size_t x = suffix.find('x', kSuffixBegin.size());
  const size_t a = suffix.find('a', kSuffixBegin.size());
  if (x == std::string_view::npos || a == std::string_view::npos || a < x) return false;
  parameters.emplace("columns", suffix.substr(kSuffixBegin.size(), x - kSuffixBegin.size()));
  parameters.emplace("rows", suffix.substr(x + 1, a - x - 1));
  parameters.emplace("aspect", suffix.substr(a + 1));
  return true;
}

absl::StatusOr<AddressParts> takeApart(const Url& url, const QuiltAddressForm& form) {
  const std::string_view rest = std::string_view(url.path).substr(form.root.size());
  AddressParts parts{
      .parameters = url.parameters, .suffix = "", .extension = form.extensions.front()};
  const size_t slash = rest.find('/');
  if (slash != std::string_view::npos) {
    std::string_view preset = rest.substr(slash + 1);
    for (const std::string& extension : form.extensions) {
      if (!preset.ends_with(extension)) continue;
      parts.extension = extension;
      preset.remove_suffix(extension.size());
      break;
    }
    parts.parameters["preset"] = preset;
    parts.parameters["stream"] = rest.substr(0, slash);
    return parts;
  }
  const size_t suffix = rest.rfind(kSuffixBegin);
  for (const std::string& extension : form.extensions) {
    if (suffix == std::string_view::npos || !rest.ends_with(extension)) continue;
    parts.extension = extension;
    parts.suffix = rest.substr(suffix, rest.size() - suffix - extension.size());
    parts.parameters["stream"] = rest.substr(0, suffix);
    if (parts.parameters.contains("preset")) return parts;
    if (readSuffix(parts.suffix, parts.parameters)) return parts;
  }
  return fieldError(absl::StatusCode::kNotFound, "url",
                    strCat("accepted are ", form.root, "STREAM/PRESET and ", form.root,
                           "STREAM_qs8x6a0.75", form.extensions.front()));
}

// "?quality=90", or nothing.
std::string queryText(const QueryParameters& parameters) {
  const std::string query = queryString(parameters);
  return query.empty() ? "" : strCat("?", query);
}

}  // namespace

absl::StatusOr<QuiltAddress> parseQuiltAddress(const Url& url, const QuiltAddressForm& form,
                                               const StreamDirectory& streams) {
  const absl::StatusOr<AddressParts> parts = takeApart(url, form);
  VIEWLOOM_RETURN_IF_ERROR(parts.status());
  absl::StatusOr<WatchRequest> request = parseWatchRequest(parts->parameters, streams);
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
    const std::string preset = parameters["preset"];
    address.file_name = strCat(address.request.stream, "_", preset, address.extension);
    if (parts->suffix.empty()) return address;
    parameters.erase("preset");
    address.redirect = strCat(form.root, stream, "/", percentEncoded(preset), address.extension,
                              queryText(parameters));
    return address;
  }
  const std::string layout = strCat(*suffix, address.extension);
  address.file_name = address.request.stream + layout;
  if (*suffix == parts->suffix) return address;
  address.redirect = strCat(form.root, stream, layout, queryText(parameters));
  return address;
}

}  // namespace viewloom
