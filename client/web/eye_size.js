// SPDX-License-Identifier: Apache-2.0
// How large the picture of an eye is: as large as its canvas where the server can, less where that
// would be slow while something moves, and as large as the canvas again once nothing does.

const kScales = [1, 0.84, 0.7, 0.59, 0.5, 0.42, 0.35, 0.25, 0.18];
const kHeightMin_px = 360;  // no picture is lower, unless its canvas is
// Pictures a second that are wanted, by what moves: the eye along the cone, or anywhere, or the
// scene alone.
const kWanted_hz = {sideways: 20, free: 10, scene: 10};
const kCauseShare = 0.8;      // and no more than this of the poses, or of the frames
const kPromised = 1.3;        // more is taken only if it promises so many times what is wanted
const kWindow_ms = 1500;      // pictures that a judgement is made of
const kLeast = 3;             // of them, or two that are far apart
const kFarApart_ms = 700;
const kHurry_ms = 350;       // without a picture: the server is too slow, whatever came before
const kHold_ms = 3000;       // after a step down, until more is tried
const kStill_ms = 300;       // without motion the eye stands
const kStillFrames = 2;      // without so many frames, at their rate, the scene stands
const kStillMax_ms = 2000;   // frames that are further apart are no motion
const kMsPerNs = 1e-6;

export class EyeSize {
  #full = {width: 1, height: 1};
  #step = 0;
  #motion = null;   // a name of kWanted_hz; null = nothing moves
  #known = {};      // the step that each motion had
  #eye = {motion: null, time_ms: -Infinity, count: 0};  // its newest move, and their number
  #scene = {time_ms: -Infinity, still_ms: kStill_ms};   // when its newest frame came
  #shown = [];      // {time_ms, cause, ms, height}, oldest first, of this motion
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

  get fullWidth_px() { return this.#full.width; }

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

  // Another connection, stream or display: nothing is known of it.
  restart() {
    const isReduced = this.#step > 0;
    this.#step = 0;
    this.#motion = null;
    this.#known = {};
    this.#eye.time_ms = this.#scene.time_ms = -Infinity;
    this.#shown = [];
    this.#asked_ms = null;
    this.#held_until_ms = -Infinity;
    this.#frame = null;
    if (isReduced) this.onChange();
  }

  // The eye is elsewhere. motion: how it went there, 'sideways' or 'free'
  noteMoved(now_ms, motion) {
    this.#eye = {motion, time_ms: now_ms, count: this.#eye.count + 1};
    this.#follow(now_ms);
    this.#asked_ms ??= now_ms;
  }

  // A picture is on the screen.
  noteShown({frame_number, layout, times}, now_ms) {
    if (this.#frame !== null && frame_number !== this.#frame) this.#noteFrame(now_ms);
    this.#frame = frame_number;
    this.#follow(now_ms);
    this.#asked_ms = null;
    this.#shown.push({
      time_ms: now_ms, height: layout.tile_size.height,
      // Number of what pictures are made of: rates of both kinds count from any number.
      cause: this.#motion === 'scene' ? Number(frame_number) : this.#eye.count,
      ms: (times.trace_ns + times.encode_ns) * kMsPerNs,
    });
    // A slow server's newest two count however old they are.
    this.#shown = this.#shown.filter(({time_ms}, index, all) =>
        now_ms - time_ms <= kWindow_ms || index >= all.length - 2);
    if (this.#motion) this.#judge(now_ms);
  }

  // Time passes: to be called several times a second.
  look(now_ms) {
    this.#follow(now_ms);
    const isEye = this.#motion !== null && this.#motion !== 'scene';
    if (!isEye || this.#asked_ms === null || now_ms - this.#asked_ms <= kHurry_ms) return;
    this.#asked_ms = now_ms;
    this.#take(this.#step + 2, now_ms);
  }

  // Another frame of the stream is seen. Frames that come seldom are a motion, too.
  #noteFrame(now_ms) {
    const interval_ms = now_ms - this.#scene.time_ms;
    const still_ms = interval_ms > kStillMax_ms ? kStill_ms :
      Math.max(kStill_ms, Math.min(kStillMax_ms, kStillFrames * interval_ms));
    this.#scene = {time_ms: now_ms, still_ms};
  }

  // Takes the size that this motion had before. A picture that stands is whole.
  #follow(now_ms) {
    const isSceneMoving = now_ms - this.#scene.time_ms <= this.#scene.still_ms;
    const isEyeMoving = now_ms - this.#eye.time_ms <= kStill_ms;
    const motion = isEyeMoving ? this.#eye.motion : isSceneMoving ? 'scene' : null;
    if (motion === this.#motion) return;
    this.#motion = motion;
    this.#shown = [];
    this.#asked_ms = null;
    const step = this.#known[motion] ?? 0;
    if (step > 0) this.#held_until_ms = now_ms + kHold_ms;
    if (step === this.#step) return;
    this.#step = step;
    this.onChange();
  }

  #judge(now_ms) {
    const {height} = this.size;
    const shown = this.#shown.filter((picture) => picture.height === height);
    if (shown.length < 2) return;
    const [first, last] = [shown[0], shown.at(-1)];
    const span_ms = last.time_ms - first.time_ms;
    if (span_ms <= 0 || (shown.length < kLeast && span_ms < kFarApart_ms)) return;
    const rate_hz = (shown.length - 1) * 1000 / span_ms;
    const causes_hz = (last.cause - first.cause) * 1000 / span_ms;
    const wanted_hz = Math.min(kWanted_hz[this.#motion], kCauseShare * causes_hz);
    if (rate_hz < wanted_hz) {
      this.#take(this.#lower(rate_hz, wanted_hz), now_ms);
      return;
    }
    if (this.#step === 0 || now_ms < this.#held_until_ms) return;
    const made_ms = shown.reduce((sum, {ms}) => sum + ms, 0) / shown.length;
    const more = (this.#steps[this.#step - 1] / this.scale) ** 2;
    // With a picture of each pose or frame, none could come sooner.
    const least_ms = rate_hz < kCauseShare * causes_hz ? 1000 / rate_hz : 0;
    if (Math.max(made_ms * more, least_ms) * kPromised * wanted_hz <= 1000) {
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
    this.#known[this.#motion] = taken;
    if (taken === this.#step) return;
    this.#step = taken;
    this.#shown = [];
    this.onChange();
  }
}
