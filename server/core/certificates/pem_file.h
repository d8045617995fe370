// SPDX-License-Identifier: Apache-2.0
// Reads files in PEM.
#pragma once

#include <string>

#include "base/status.h"

namespace viewloom {

// A file, and the setting or option that named it: errors begin with both.
struct NamedFile {
  std::string option;  // "tls.key", "--tls-key"
  std::string path;

  // INVALID_ARGUMENT "OPTION PATH: PROBLEM".
  absl::Status error(const std::string& problem) const;
};

// Reads a regular file of at most 1 MiB. INVALID_ARGUMENT, with the remedy, when it cannot be read.
absl::StatusOr<std::string> readPemFile(const NamedFile& file);

// Whether a text in PEM holds a private key, of any form.
bool holdsPrivateKey(const std::string& pem);

}  // namespace viewloom
