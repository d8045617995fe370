// SPDX-License-Identifier: Apache-2.0
// The commands of viewloom-bench: `trace`, `build`, `displays`, `uplink`, `ingest`, `stereo`,
// `knob`, `mirrors`, `retime`, `ticks`, `video`, `quality` and `pictures`.
#pragma once

namespace viewloom::bench {

// The exit status of the process. Throws what cannot be measured.
int runBench(int argc, char** argv);

}  // namespace viewloom::bench
