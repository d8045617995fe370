// SPDX-License-Identifier: Apache-2.0
#include "offline/score_json.h"

#include <cmath>

namespace viewloom {
namespace {

using Json = nlohmann::ordered_json;

Json classJson(const ImageScore& score) {
  Json json;
  json["pixels"] = score.pixel_count;
  json["share"] = score.share;
  if (score.pixel_count == 0) {
    json["psnr_db"] = nullptr;
    json["ssim"] = nullptr;
    json["flip"] = nullptr;
  } else {
    json["psnr_db"] = std::isinf(score.psnr_db) ? Json("inf") : Json(score.psnr_db);
    json["ssim"] = score.ssim;
    json["flip"] = score.flip;
  }
  return json;
}

}  // namespace

Json scoreJson(const ClassScores& scores) {
  return {{"covered", classJson(scores.covered)},
          {"hidden", classJson(scores.hidden)},
          {"outside", classJson(scores.outside)},
          {"all", classJson(scores.all)}};
}

}  // namespace viewloom
