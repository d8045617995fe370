// SPDX-License-Identifier: Apache-2.0
// Pictures served to the eyes of a moving head, beside the true ones.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "gpu/device.h"

namespace viewloom::bench {

// A head track before each of the truth kit's scenes, of which one frame was published, with one
// layer and with three: [{"scene", "layers", "poses", "inside_db", "known_db", "full_db",
// "still_db", "worst_known_db", "outside_share", "outside_differs_share", "depth_off_share"}].
// PSNR in dB over sRGB codes, of all poses and both eyes together; "still_db" is that of what the
// eyes saw before they moved, in place of what they were served. See test::EyeScore.
nlohmann::ordered_json qualityOfStereo(const Device& device);

}  // namespace viewloom::bench
