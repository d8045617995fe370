// SPDX-License-Identifier: Apache-2.0
// Chooses how finely the display is traced, so that a slow server still gives a moving picture.

const kDetails = [1, 0.5, 0.25];  // of the preset's width and height
const kStart = 0.5;
const kTarget_ms = 110;       // what an atlas may cost the server: nine a second
const kRaiseShare = 0.7;      // of it: more detail is only taken with room to spare
const kJudgedCount = 6;       // atlases of one size before it is judged

const kMsPerNs = 1e-6;

export class AutoDetail {
  #costs = [];  // {fixed_ms, traced_ms} of the newest atlases of this detail

  // onChange(): detail is another
  constructor(onChange) {
    this.onChange = onChange;
    this.detail = kStart;
  }

  note({times, layout}) {
    const size = `${layout.size.width}x${layout.size.height}`;
    if (size !== this.size) this.#costs = [];
    this.size = size;
    this.#costs.push({
      fixed_ms: (times.upload_ns + times.build_ns) * kMsPerNs,
      traced_ms: (times.trace_ns + times.encode_ns) * kMsPerNs,
    });
    if (this.#costs.length < kJudgedCount) return;
    const better = this.#affordable();
    this.#costs = [];
    if (better === this.detail) return;
    this.detail = better;
    this.onChange();
  }

  // Tracing and encoding grow with the number of pixels, the rest does not.
  #affordable() {
    const mean = (key) => this.#costs.reduce((sum, cost) => sum + cost[key], 0) / kJudgedCount;
    const fixed_ms = mean('fixed_ms');
    const traced_ms = mean('traced_ms');
    const fits = (detail) => {
      const allowed_ms = detail > this.detail ? kTarget_ms * kRaiseShare : kTarget_ms;
      return fixed_ms + traced_ms * (detail / this.detail) ** 2 <= allowed_ms;
    };
    return kDetails.find(fits) ?? kDetails.at(-1);
  }
}
