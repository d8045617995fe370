// SPDX-License-Identifier: Apache-2.0
#include "access/rights_json.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_join.h"
#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

using nlohmann::json;

struct QuotaField {
  const char* name;
  std::optional<uint64_t> Quota::*value;
};
constexpr std::array kQuotaFields = {
    QuotaField{"connections", &Quota::connections}, QuotaField{"streams", &Quota::streams},
    QuotaField{"displays", &Quota::displays}, QuotaField{"pixels_per_s", &Quota::pixels_per_s},
    QuotaField{"bytes_per_s", &Quota::bytes_per_s}};

absl::StatusOr<std::vector<std::string>> wordsOf(const json& object, const char* field) {
  const auto found = object.find(field);
  if (found == object.end()) return invalidField(field, "is missing; give a list of texts");
  if (found->is_string()) return std::vector<std::string>{found->get<std::string>()};
  const bool is_list =
      found->is_array() &&
      std::all_of(found->begin(), found->end(), [](const json& e) { return e.is_string(); });
  if (!is_list) return invalidField(field, "is no list of texts; accepted is [\"...\", \"...\"]");
  return found->get<std::vector<std::string>>();
}

absl::StatusOr<Quota> quotaOf(const json& object) {
  Quota quota;
  const auto found = object.find("limits");
  if (found == object.end()) return quota;
  std::vector<std::string> names;
  for (const QuotaField& field : kQuotaFields) names.emplace_back(field.name);
  if (!found->is_object()) {
    return invalidField("limits", strCat("is no object; accepted is one with some of ",
                                         absl::StrJoin(names, ", ")));
  }
  for (const auto& [name, value] : found->items()) {
    const auto* const field = std::ranges::find(kQuotaFields, name, &QuotaField::name);
    if (field == kQuotaFields.end()) {
      const std::string meant = didYouMean(name, names);
      return invalidField("limits",
                          strCat("there is no limit \"", printable(name), "\"; accepted are ",
                                 absl::StrJoin(names, ", "), meant.empty() ? "" : "; ", meant));
    }
    if (!value.is_number_unsigned()) {
      return invalidField(strCat("limits.", name), "is no whole number; accepted is 0 or more");
    }
    quota.*(field->value) = value.get<uint64_t>();
  }
  return quota;
}

}  // namespace

absl::StatusOr<Rights> rightsFromJson(const json& object) {
  Rights rights;
  const absl::StatusOr<std::vector<std::string>> words = wordsOf(object, "roles");
  VIEWLOOM_RETURN_IF_ERROR(words.status());
  absl::StatusOr<std::vector<Role>> roles = rolesFromWords(*words);
  VIEWLOOM_RETURN_IF_ERROR(roles.status());
  rights.roles = *std::move(roles);
  absl::StatusOr<std::vector<std::string>> patterns = wordsOf(object, "streams");
  VIEWLOOM_RETURN_IF_ERROR(patterns.status());
  absl::StatusOr<StreamPatterns> streams = StreamPatterns::parse(*std::move(patterns));
  VIEWLOOM_RETURN_IF_ERROR(streams.status());
  rights.streams = *std::move(streams);
  const absl::StatusOr<Quota> quota = quotaOf(object);
  VIEWLOOM_RETURN_IF_ERROR(quota.status());
  rights.quota = *quota;
  return rights;
}

void addRights(const Rights& rights, nlohmann::ordered_json& object) {
  for (const Role role : rights.roles) object["roles"].push_back(std::string(wordOf(role)));
  object["streams"] = rights.streams.texts();
  for (const QuotaField& field : kQuotaFields) {
    const std::optional<uint64_t>& value = rights.quota.*(field.value);
    if (value) object["limits"][field.name] = *value;
  }
}

}  // namespace viewloom
