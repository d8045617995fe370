// SPDX-License-Identifier: Apache-2.0
#include "base/json_nesting.h"

namespace viewloom {

bool isNestedDeeply(std::string_view json, size_t depth_max) {
  size_t depth = 0;
  bool is_in_text = false;
  for (size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '"') is_in_text = !is_in_text;
    if (is_in_text) {
      i += c == '\\';  // the next character is no end
    } else if (c == '[' || c == '{') {
      if (++depth > depth_max) return true;
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    }
  }
  return false;
}

}  // namespace viewloom
