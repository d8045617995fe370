// SPDX-License-Identifier: Apache-2.0
// How much of a time goes with the pixels of a picture: learnt from pictures of several sizes.

const kNewest = 5;             // of a size, whose median counts
const kTogether_ms = 5000;     // measurements that are further apart are of another time
const kRemembered_ms = 60_000;  // how long another size says something
const kOther = 0.9;            // of the pixels: sizes that are closer say nothing together

function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.floor((sorted.length - 1) / 2)];
}

export class PixelCost {
  #sizes = new Map();  // by pixels: {times: the newest, ms, time_ms: when the last one came}

  note(pixels, ms, now_ms) {
    const before = this.#sizes.get(pixels);
    const isNew = !before || now_ms - before.time_ms > kTogether_ms;
    const times = [...(isNew ? [] : before.times), ms].slice(-kNewest);
    this.#sizes.delete(pixels);  // so that the newest is the last
    this.#sizes.set(pixels, {times, time_ms: now_ms});
    for (const [size, {time_ms}] of this.#sizes) {  // the oldest first
      if (now_ms - time_ms <= kRemembered_ms) break;
      this.#sizes.delete(size);
    }
  }

  // How often a picture of this size was measured lately.
  count(pixels) { return this.#sizes.get(pixels)?.times.length ?? 0; }

  // The part that goes with the pixels, ms. Two sizes tell it. All of it does as long as there is
  // one size alone; 0 if this one was not measured.
  of(pixels, now_ms) {
    const own = this.#sizes.get(pixels);
    if (!own) return 0;
    const ms = median(own.times);
    const other = [...this.#sizes].reverse().find(([count, {time_ms}]) =>
        now_ms - time_ms <= kRemembered_ms &&
        Math.min(count, pixels) < kOther * Math.max(count, pixels));
    if (!other) return ms;
    const [count, {times}] = other;
    const perPixel_ms = (ms - median(times)) / (pixels - count);
    return Math.max(0, Math.min(ms, perPixel_ms * pixels));
  }
}
