// SPDX-License-Identifier: Apache-2.0
// Good bytes for each function of targets.h.
#pragma once

#include <string>
#include <vector>

#include "fuzz/fuzz_target.h"

namespace viewloom {

// Puts bytes together, one after the other.
class SeedWriter {
 public:
  SeedWriter& bytes(const std::vector<uint8_t>& more) {
    bytes_.insert(bytes_.end(), more.begin(), more.end());
    return *this;
  }
  SeedWriter& text(const std::string& more) {
    bytes_.insert(bytes_.end(), more.begin(), more.end());
    return *this;
  }
  // The length in two bytes, the higher first, then the text.
  SeedWriter& counted(const std::string& more) {
    bytes({static_cast<uint8_t>(more.size() >> 8), static_cast<uint8_t>(more.size())});
    return text(more);
  }
  std::vector<uint8_t> done() const { return bytes_; }

 private:
  std::vector<uint8_t> bytes_;
};

SeedBytes jpegSeeds();
SeedBytes zstdSeeds();
SeedBytes predictedSeeds();
SeedBytes videoPlaneSeeds();
SeedBytes frameSeeds();
SeedBytes videoSeeds();

SeedBytes headerSeeds();
SeedBytes displaySeeds();
SeedBytes eyePosesSeeds();
SeedBytes chunkSeeds();
SeedBytes callSeeds();
SeedBytes atlasSeeds();
SeedBytes recordingSeeds();

SeedBytes displayJsonSeeds();
SeedBytes calibrationSeeds();
SeedBytes viewerSeeds();
SeedBytes httpSeeds();
SeedBytes settingsSeeds();
SeedBytes manifestSeeds();
SeedBytes cameraListSeeds();
SeedBytes eyeLineSeeds();

SeedBytes tokensSeeds();
SeedBytes jwtSeeds();
SeedBytes keySetSeeds();
SeedBytes linkSeeds();
SeedBytes certificateSeeds();

SeedBytes pictureSeeds();
SeedBytes metadataSeeds();
SeedBytes exrSeeds();

}  // namespace viewloom
