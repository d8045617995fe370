// SPDX-License-Identifier: Apache-2.0
// How large the picture of a moving eye is: as large as its canvas where the server can, less where
// that would be slow, and as large as the canvas again once the eye stands.

const kScales = [1, 0.84, 0.7, 0.59, 0.5, 0.42, 0.35, 0.25, 0.18];
const kHeightMin_px = 360;   // no picture is lower, unless its canvas is
const kWanted_hz = 10;       // of pictures, while something moves
const kPublishedShare = 0.8;  // of the frames of a stream that moves by itself
const kPromised_hz = 13;     // more is taken only if it promises this much
const kWindow_ms = 1500;     // pictures that a judgement is made of
const kLeast = 3;            // of them
const kHurry_ms = 350;       // without a picture: the server is too slow, whatever came before
const kHold_ms = 3000;       // after a step down, until more is tried
const kStill_ms = 300;       // without motion the eye stands
const kMsPerNs = 1e-6;

export class EyeSize {
  #full = {width: 1, height: 1};
  #step = 0;
  #moving = 0;      // the step that motion had
  #moved_ms = -Infinity;
  #shown = [];      // {time_ms, frame, ms, height}, oldest first
  #asked_ms = null;  // a pose of this motion that no picture answered yet
  #held_until_ms = -Infinity;
  #frame = null;

  // onChange(): another size
  constructor(onChange) {
    this.onChange = onChange;
  }

  // px of the canvas that the picture covers.
  fit({width, height}) {
    this.#full = {width, height};
  }

  get #steps() {
    const least = Math.min(1, kHeightMin_px / this.#full.height);
    return [...kScales.filter((scale) => scale > least), least].filter(
        (scale, index, all) => index === 0 || scale < all[index - 1]);
  }

  get scale() {
    const steps = this.#steps;
    return steps[Math.min(this.#step, steps.length - 1)];
  }

  // {width, height}, even, px.
  get size() {
    const side = (px) => Math.max(2, 2 * Math.round(px * this.scale / 2));
    return {width: side(this.#full.width), height: side(this.#full.height)};
  }

  // Another stream or display: nothing is known of it.
  restart() {
    this.#step = this.#moving = 0;
    this.#shown = [];
    this.#asked_ms = null;
    this.#frame = null;
    this.#moved_ms = -Infinity;
    this.#held_until_ms = -Infinity;
  }

  // The eye is elsewhere.
  noteMoved(now_ms) {
    this.#begin(now_ms);
    this.#moved_ms = now_ms;
    this.#asked_ms ??= now_ms;
  }

  // A picture is on the screen.
  noteShown({frame_number, layout, times}, now_ms) {
    const isMotion = this.#frame !== null && frame_number !== this.#frame;
    this.#frame = frame_number;
    if (isMotion) {
      this.#begin(now_ms);
      this.#moved_ms = now_ms;
    }
    this.#asked_ms = null;
    this.#shown.push({
      time_ms: now_ms, frame: Number(frame_number), height: layout.tile_size.height,
      ms: (times.trace_ns + times.encode_ns) * kMsPerNs,
    });
    this.#shown = this.#shown.filter(({time_ms}) => now_ms - time_ms <= kWindow_ms);
    this.#judge(now_ms);
  }

  // Time passes: to be called several times a second.
  look(now_ms) {
    if (this.#asked_ms !== null && now_ms - this.#asked_ms > kHurry_ms &&
        now_ms - this.#moved_ms < kStill_ms) {
      this.#asked_ms = now_ms;
      this.#take(this.#step + 2, now_ms);
    } else if (this.#step > 0 && now_ms - this.#moved_ms > kStill_ms) {
      this.#moving = this.#step;
      this.#step = 0;
      this.#shown = [];
      this.#asked_ms = null;
      this.onChange();
    }
  }

  // It moves again, and what was learnt of motion holds.
  #begin(now_ms) {
    if (now_ms - this.#moved_ms <= kStill_ms) return;
    this.#shown = [];
    if (this.#moving === 0) return;
    this.#step = this.#moving;
    this.#held_until_ms = now_ms + kHold_ms;
    this.onChange();
  }

  #judge(now_ms) {
    const {height} = this.size;
    const shown = this.#shown.filter((picture) => picture.height === height);
    if (shown.length < kLeast) return;
    const [first, last] = [shown[0], shown.at(-1)];
    const span_ms = last.time_ms - first.time_ms;
    if (span_ms <= 0) return;
    const rate_hz = (shown.length - 1) * 1000 / span_ms;
    const frames_hz = (last.frame - first.frame) * 1000 / span_ms;
    const isEye = now_ms - this.#moved_ms < kStill_ms && frames_hz < rate_hz / 2;
    const wanted_hz = isEye ? kWanted_hz : Math.min(kWanted_hz, kPublishedShare * frames_hz);
    if (rate_hz < wanted_hz) {
      this.#take(this.#lower(rate_hz, wanted_hz), now_ms);
      return;
    }
    if (this.#step === 0 || now_ms < this.#held_until_ms) return;
    const made_ms = shown.reduce((sum, {ms}) => sum + ms, 0) / shown.length;
    const more = (this.#steps[this.#step - 1] / this.scale) ** 2;
    if (Math.max(made_ms * more, 1000 / rate_hz) * kPromised_hz <= 1000) {
      this.#take(this.#step - 1, now_ms);
    }
  }

  // The largest size that promises the rate, if time goes with the px.
  #lower(rate_hz, wanted_hz) {
    const steps = this.#steps;
    const scale = this.scale * Math.sqrt(rate_hz / wanted_hz);
    const found = steps.findIndex((step) => step <= scale);
    return found < 0 ? steps.length - 1 : found;
  }

  #take(step, now_ms) {
    const taken = Math.max(0, Math.min(this.#steps.length - 1, step));
    if (taken > this.#step) this.#held_until_ms = now_ms + kHold_ms;
    if (taken === this.#step) return;
    this.#step = this.#moving = taken;
    this.#shown = [];
    this.onChange();
  }
}
