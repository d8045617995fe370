// SPDX-License-Identifier: Apache-2.0
#include "access/rights.h"

#include <algorithm>
#include <array>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_join.h"
#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr size_t kPatternLengthMax = 64;  // as names of streams
constexpr size_t kPatternCountMax = 32;

struct RoleWord {
  Role role;
  std::string_view word;
};
constexpr std::array kRoleWords = {RoleWord{Role::kPublish, "publish"},
                                   RoleWord{Role::kWatch, "watch"},
                                   RoleWord{Role::kOperate, "operate"}};

bool isOfPatterns(char c) {
  return absl::ascii_isalnum(static_cast<unsigned char>(c)) ||
         std::string_view("._-*").find(c) != std::string_view::npos;
}

// Goes back to the newest '*' alone: an older one could only match more of what it has passed.
bool matchesOne(std::string_view pattern, std::string_view name) {
  size_t at = 0;
  size_t of_name = 0;
  size_t star = std::string_view::npos;
  size_t after_star = 0;
  while (of_name < name.size()) {
    if (at < pattern.size() && pattern[at] == '*') {
      star = at++;
      after_star = of_name;
    } else if (at < pattern.size() && pattern[at] == name[of_name]) {
      ++at;
      ++of_name;
    } else if (star != std::string_view::npos) {
      at = star + 1;
      of_name = ++after_star;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', at) == std::string_view::npos;
}

}  // namespace

std::string_view wordOf(Role role) {
  return std::ranges::find(kRoleWords, role, &RoleWord::role)->word;
}

std::optional<Role> roleOf(std::string_view word) {
  const auto* const found = std::ranges::find(kRoleWords, word, &RoleWord::word);
  return found == kRoleWords.end() ? std::nullopt : std::optional(found->role);
}

absl::StatusOr<StreamPatterns> StreamPatterns::parse(std::vector<std::string> patterns) {
  if (patterns.size() > kPatternCountMax) {
    return invalidField("streams", strCat("there are ", patterns.size(),
                                          " patterns; accepted are up to ", kPatternCountMax));
  }
  for (const std::string& pattern : patterns) {
    const bool fits = !pattern.empty() && pattern.size() <= kPatternLengthMax;
    if (fits && std::ranges::all_of(pattern, isOfPatterns)) continue;
    return invalidField("streams",
                        strCat("the pattern is \"", printable(pattern.substr(0, kPatternLengthMax)),
                               "\"; accepted are 1 to ", kPatternLengthMax,
                               " characters from A-Z a-z 0-9 . _ - and *, as in room.*"));
  }
  return StreamPatterns(std::move(patterns));
}

StreamPatterns StreamPatterns::all() {
  return StreamPatterns({"*"});
}

bool StreamPatterns::matches(std::string_view stream) const {
  return std::ranges::any_of(
      texts_, [stream](const std::string& pattern) { return matchesOne(pattern, stream); });
}

std::string StreamPatterns::text() const {
  return texts_.empty() ? "none" : absl::StrJoin(texts_, ", ");
}

bool Rights::has(Role role) const {
  return std::ranges::find(roles, role) != roles.end();
}

std::string Rights::rolesText() const {
  return absl::StrJoin(roles, ", ", [](std::string* text, Role role) { *text += wordOf(role); });
}

Rights allRights() {
  return {.roles = {Role::kPublish, Role::kWatch, Role::kOperate},
          .streams = StreamPatterns::all(),
          .quota = {}};
}

absl::StatusOr<std::vector<Role>> rolesFromWords(const std::vector<std::string>& words) {
  std::vector<Role> roles;
  for (const std::string& word : words) {
    const std::optional<Role> role = roleOf(word);
    if (!role) {
      std::vector<std::string> known;
      for (const RoleWord& entry : kRoleWords) known.emplace_back(entry.word);
      const std::string meant = didYouMean(word, known);
      return invalidField("roles",
                          strCat("got \"", printable(word), "\"; accepted are ",
                                 absl::StrJoin(known, ", "), meant.empty() ? "" : "; ", meant));
    }
    roles.push_back(*role);
  }
  if (roles.empty()) {
    return invalidField("roles", "there is none; accepted are publish, watch and operate");
  }
  std::ranges::sort(roles);
  roles.erase(std::unique(roles.begin(), roles.end()), roles.end());
  return roles;
}

}  // namespace viewloom
