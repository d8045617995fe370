// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "fuzz/fuzz_target.h"
#include "fuzz/seeds.h"
#include "fuzz/targets.h"

namespace viewloom {
namespace {

constexpr std::array kTargets = {
    FuzzTarget{"atlas", fuzzAtlas, atlasSeeds},
    FuzzTarget{"calibration", fuzzCalibration, calibrationSeeds},
    FuzzTarget{"calls", fuzzCalls, callSeeds},
    FuzzTarget{"camera_list", fuzzCameraList, cameraListSeeds},
    FuzzTarget{"certificate", fuzzCertificate, certificateSeeds},
    FuzzTarget{"chunk", fuzzChunk, chunkSeeds},
    FuzzTarget{"display", fuzzDisplay, displaySeeds},
    FuzzTarget{"display_json", fuzzDisplayJson, displayJsonSeeds},
    FuzzTarget{"exr", fuzzExr, exrSeeds},
    FuzzTarget{"eye_line", fuzzEyeLine, eyeLineSeeds},
    FuzzTarget{"eye_poses", fuzzEyePoses, eyePosesSeeds},
    FuzzTarget{"frame", fuzzFrame, frameSeeds},
    FuzzTarget{"header", fuzzHeader, headerSeeds},
    FuzzTarget{"http", fuzzHttp, httpSeeds},
    FuzzTarget{"jpeg", fuzzJpeg, jpegSeeds},
    FuzzTarget{"jwt", fuzzJwt, jwtSeeds},
    FuzzTarget{"key_set", fuzzKeySet, keySetSeeds},
    FuzzTarget{"link", fuzzLink, linkSeeds},
    FuzzTarget{"manifest", fuzzManifest, manifestSeeds},
    FuzzTarget{"metadata", fuzzMetadata, metadataSeeds},
    FuzzTarget{"picture", fuzzPicture, pictureSeeds},
    FuzzTarget{"predicted", fuzzPredicted, predictedSeeds},
    FuzzTarget{"recording", fuzzRecording, recordingSeeds},
    FuzzTarget{"settings", fuzzSettings, settingsSeeds},
    FuzzTarget{"tokens", fuzzTokens, tokensSeeds},
    FuzzTarget{"video", fuzzVideo, videoSeeds},
    FuzzTarget{"video_plane", fuzzVideoPlane, videoPlaneSeeds},
    FuzzTarget{"viewer", fuzzViewer, viewerSeeds},
    FuzzTarget{"zstd", fuzzZstd, zstdSeeds},
};

}  // namespace

std::span<const FuzzTarget> fuzzTargets() {
  return kTargets;
}

const FuzzTarget* findFuzzTarget(std::string_view name) {
  const auto* const found = std::ranges::find(kTargets, name, &FuzzTarget::name);
  return found == kTargets.end() ? nullptr : found;
}

}  // namespace viewloom
