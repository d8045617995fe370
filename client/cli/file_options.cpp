// SPDX-License-Identifier: Apache-2.0
#include "cli/file_options.h"

namespace viewloom::cli {

void addFileOptions(const usage::Command& app, FileFeedOptions& options) {
  const char* const group = "What";
  app.add("colour", options.colors,
          "Colour files, one a frame: EXR (with depth in Z or alike), HEIC (portrait photos), PNG, "
          "JPEG, TIFF, WebP, PFM, PGM, PPM, BMP, NPY, .yuv; told by content, not by name")
      .group(group);
  app.add("--depth", options.depths, "Depth files, one a frame: as colour, and DPT").group(group);
  app.add("--deep", options.deeps,
          "Deep EXR files, one a frame: R, G, B, A, Z and perhaps ZBack; split into layers "
          "with the least occlusion error, which is told")
      .group(group);
  app.addFlag(
         "--black-sky", options.loader.has_black_sky,
         "Light that all samples of a deep px let through comes from a black sky, not from what "
         "lies beside the px")
      .group(group);
  app.add("--view", options.view,
          "View of multi-view EXR files, as right or left [the file's default]")
      .group(group);
  app.add("--manifest", options.manifests,
          "Manifests (JSON), one a frame: layers, cameras, everything")
      .group(group);
}

}  // namespace viewloom::cli
