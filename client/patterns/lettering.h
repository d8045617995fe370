// SPDX-License-Identifier: Apache-2.0
// Letters of every size that a pattern needs.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "text/font.h"

namespace viewloom::patterns {

// Thread-safety: as Font.
class Lettering {
 public:
  // An empty picture where it cannot be written; status() says why.
  WrittenText write(double em_px, const std::string& text);
  // The first problem there was.
  const absl::Status& status() const { return status_; }

 private:
  std::map<int, std::unique_ptr<Font>> fonts_;  // by their size, px
  absl::Status status_;
};

}  // namespace viewloom::patterns
