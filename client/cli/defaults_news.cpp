// SPDX-License-Identifier: Apache-2.0
#include "cli/defaults_news.h"

#include <utility>

#include "base/str_cat.h"

namespace viewloom::cli {

std::optional<std::string> DefaultsNews::note(const v1::AtlasHeader& header,
                                              const std::string& taken) {
  const uint64_t before = std::exchange(count_, header.defaults_count());
  const bool is_other = std::exchange(taken_, taken) != taken;
  if (before == 0 || count_ <= before || !is_other) return std::nullopt;
  const bool has_moved = header.defaults_reason() == v1::DEFAULTS_REASON_DEPTH_MOVED;
  return strCat(has_moved ? "the stream's depth has moved by more than a factor of four: "
                          : "the stream has a new publisher: ",
                taken);
}

}  // namespace viewloom::cli
