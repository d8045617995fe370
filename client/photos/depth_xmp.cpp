// SPDX-License-Identifier: Apache-2.0
#include "photos/depth_xmp.h"

#include <cmath>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/string_view.h"
#include "base/str_cat.h"

namespace viewloom::photos {
namespace {

bool isQuote(char c) {
  return c == '"' || c == '\'';
}

// The prefix that `uri` is bound to; "" without one.
std::string prefixOf(absl::string_view xml, absl::string_view uri) {
  for (size_t at = xml.find(uri); at != absl::string_view::npos; at = xml.find(uri, at + 1)) {
    absl::string_view before = xml.substr(0, at);
    if (before.empty() || !isQuote(before.back())) continue;
    before = absl::StripTrailingAsciiWhitespace(before.substr(0, before.size() - 1));
    if (before.empty() || before.back() != '=') continue;
    before = absl::StripTrailingAsciiWhitespace(before.substr(0, before.size() - 1));
    const size_t name = before.rfind("xmlns:");
    if (name != absl::string_view::npos) return std::string(before.substr(name + 6));
  }
  return "";
}

// The text of an element without attributes, or an attribute's value, named `prefix`:`name`.
std::string valueOf(absl::string_view xml, const std::string& prefix, const char* name) {
  const std::string full = strCat(prefix, ":", name);
  for (size_t at = xml.find(full); at != absl::string_view::npos; at = xml.find(full, at + 1)) {
    const bool begins = at > 0 && (xml[at - 1] == '<' ||
                                   absl::ascii_isspace(static_cast<unsigned char>(xml[at - 1])));
    absl::string_view rest = absl::StripLeadingAsciiWhitespace(xml.substr(at + full.size()));
    if (!begins || rest.empty()) continue;
    char end = '<';
    if (rest.front() == '=') {
      rest = absl::StripLeadingAsciiWhitespace(rest.substr(1));
      if (rest.empty() || !isQuote(rest.front())) continue;
      end = rest.front();
    } else if (rest.front() != '>') {
      continue;
    }
    rest.remove_prefix(1);
    const size_t length = rest.find(end);
    if (length == absl::string_view::npos) continue;
    return std::string(absl::StripAsciiWhitespace(rest.substr(0, length)));
  }
  return "";
}

std::optional<double> numberOf(absl::string_view xml, const std::string& prefix, const char* name) {
  double number = 0;
  if (!absl::SimpleAtod(valueOf(xml, prefix, name), &number)) return std::nullopt;
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

}  // namespace

DepthXmp parseDepthXmp(std::string_view text) {
  const absl::string_view xml(text.data(), text.size());
  DepthXmp parsed;
  const std::string pixels = prefixOf(xml, "http://ns.apple.com/pixeldatainfo/1.0/");
  if (!pixels.empty()) {
    parsed.image_type = valueOf(xml, pixels, "AuxiliaryImageType");
    parsed.int_min = numberOf(xml, pixels, "IntMinValue");
    parsed.int_max = numberOf(xml, pixels, "IntMaxValue");
    parsed.float_min = numberOf(xml, pixels, "FloatMinValue");
    parsed.float_max = numberOf(xml, pixels, "FloatMaxValue");
  }
  const std::string depth = prefixOf(xml, "http://ns.apple.com/depthData/1.0/");
  if (!depth.empty()) parsed.accuracy = valueOf(xml, depth, "Accuracy");
  return parsed;
}

std::optional<GoogleDepth> parseGoogleDepth(std::string_view xml, std::string_view extended_xml) {
  constexpr char kNamespace[] = "http://ns.google.com/photos/1.0/depthmap/";
  GoogleDepth parsed;
  std::optional<double> unit_m;
  for (const std::string_view text : {xml, extended_xml}) {
    const absl::string_view part(text.data(), text.size());
    const std::string prefix = prefixOf(part, kNamespace);
    if (prefix.empty()) continue;
    if (parsed.data.empty()) parsed.data = valueOf(part, prefix, "Data");
    if (parsed.format.empty()) parsed.format = valueOf(part, prefix, "Format");
    if (!parsed.near_m) parsed.near_m = numberOf(part, prefix, "Near");
    if (!parsed.far_m) parsed.far_m = numberOf(part, prefix, "Far");
    if (valueOf(part, prefix, "Units") == "mm") unit_m = 0.001;
  }
  if (parsed.data.empty()) return std::nullopt;
  for (std::optional<double>* distance : {&parsed.near_m, &parsed.far_m}) {
    if (*distance) **distance *= unit_m.value_or(1);
  }
  return parsed;
}

}  // namespace viewloom::photos
