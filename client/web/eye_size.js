// SPDX-License-Identifier: Apache-2.0
// How large the picture of an eye is: as large as its canvas where the server can, less where its
// pixels make it slow while something moves, and as large as the canvas again once nothing does.
import {PixelCost} from './pixel_cost.js';

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
const kHurry_ms = 350;       // without a picture, beyond the latency of the line: it is too slow
const kUnderWay = 2;         // pictures that are sent before one was shown (proto/web.md)
const kWorthShare = 0.1;     // of the time of a picture: a step that saves less is not taken
const kHold_ms = 3000;       // after a step down, until more is tried
const kStill_ms = 300;       // without motion the eye stands
const kStillFrames = 2;      // without so many frames, at their rate, the scene stands
const kStillMax_ms = 2000;   // pictures that are further apart are no motion
const kStillFrame_ms = 325;  // nor are frames that are published so far apart
const kMsPerNs = 1e-6;

export class EyeSize {
  #full = {width: 1, height: 1};
  #step = 0;
  #motion = null;   // a name of kWanted_hz; null = nothing moves
  #known = {};      // the step that each motion had
  #eye = {motion: null, time_ms: -Infinity, count: 0};  // its newest move, and their number
  #scene = {time_ms: -Infinity, still_ms: kStill_ms};   // when its newest frame came
  #shown = [];      // {time_ms, cause, height}, oldest first, of this motion
  #line_ms = null;  // there and back, without anything on it; null = unknown
  #alike = {height: 0, count: 0};  // pictures of one height that came one after the other
  // Time that goes with pixels: of making a picture, of its way, and by motion of the time between
  // two.
  #making = new PixelCost();
  #way = new PixelCost();
  #paces = {};
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
    this.#alike = {height: 0, count: 0};
    this.#making = new PixelCost();
    this.#way = new PixelCost();
    this.#paces = {};
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

  // A picture is on the screen. line_ms: how long a message takes there and back; null = unknown
  noteShown({frame_number, layout, times, shown_ns}, now_ms, line_ms = null) {
    const frame = Number(frame_number);
    if (this.#frame !== null && frame !== this.#frame) this.#noteFrame(now_ms, frame - this.#frame);
    this.#frame = frame;
    this.#line_ms = line_ms;
    this.#follow(now_ms);
    this.#asked_ms = null;
    const {height} = layout.tile_size;
    this.#measure(height, times, shown_ns * kMsPerNs, now_ms);
    // Number of what pictures are made of: rates of both kinds count from any number.
    const cause = this.#motion === 'scene' ? frame : this.#eye.count;
    this.#shown.push({time_ms: now_ms, height, cause});
    // A slow server's newest two count however old they are.
    this.#shown = this.#shown.filter(({time_ms}, index, all) =>
        now_ms - time_ms <= kWindow_ms || index >= all.length - 2);
    if (this.#motion) this.#judge(now_ms);
  }

  // Time passes: to be called several times a second.
  look(now_ms) {
    this.#follow(now_ms);
    const isEye = this.#motion !== null && this.#motion !== 'scene';
    const patience_ms = kHurry_ms + (this.#line_ms ?? 0);
    if (!isEye || this.#asked_ms === null || now_ms - this.#asked_ms <= patience_ms) return;
    this.#asked_ms = now_ms;
    // One picture may have been slow for another reason, and what takes long now may be no picture.
    const pixels_ms = this.#pixels_ms(now_ms);
    if (this.#making.count(this.#pixels) < 2 || 2 * pixels_ms < kHurry_ms) return;
    const measured = {interval_ms: pixels_ms, pixels_ms, wanted_hz: kWanted_hz[this.#motion]};
    this.#take(this.#lower(measured), now_ms);
  }

  get #pixels() {
    const {width, height} = this.size;
    return width * height;
  }

  // Notes the times of a picture, if it has the size that is asked for. shown_ms: from the server
  // to the screen and back, of a picture shortly before
  #measure(height, {trace_ns, encode_ns}, shown_ms, now_ms) {
    if (height !== this.#alike.height) this.#alike = {height, count: 0};
    this.#alike.count++;
    if (height !== this.size.height) return;
    this.#making.note(this.#pixels, (trace_ns + encode_ns) * kMsPerNs, now_ms);
    if (this.#line_ms === null || this.#alike.count <= kUnderWay) return;
    this.#way.note(this.#pixels, Math.max(0, shown_ms - this.#line_ms) / kUnderWay, now_ms);
  }

  // How much of the time between two pictures goes with their pixels; no more than intervals of
  // other sizes tell.
  #pixels_ms(now_ms) {
    const pixels = this.#pixels;
    const pace = this.#paces[this.#motion];
    const most_ms = pace?.count(pixels) ? pace.of(pixels, now_ms) : Infinity;
    return Math.min(
        most_ms, Math.max(this.#making.of(pixels, now_ms), this.#way.of(pixels, now_ms)));
  }

  // Another frame of the stream is seen, `count` after the one before. Frames that come seldom are
  // a motion, too.
  #noteFrame(now_ms, count) {
    const interval_ms = now_ms - this.#scene.time_ms;
    const isSeldom = interval_ms / Math.max(1, count) > kStillFrame_ms;
    const still_ms = isSeldom || interval_ms > kStillMax_ms ? kStill_ms :
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
    const interval_ms = span_ms / (shown.length - 1);
    const rate_hz = 1000 / interval_ms;
    const causes_hz = (last.cause - first.cause) * 1000 / span_ms;
    const wanted_hz = Math.min(kWanted_hz[this.#motion], kCauseShare * causes_hz);
    const isSlow = rate_hz < wanted_hz;
    if (isSlow) this.#notePace(interval_ms, now_ms);
    const pixels_ms = this.#pixels_ms(now_ms);
    if (isSlow) {
      const measured = {interval_ms, pixels_ms: Math.min(interval_ms, pixels_ms), wanted_hz};
      const step = this.#lower(measured);
      if (step > this.#step) {
        this.#take(step, now_ms);
        return;
      }
    }
    const free = this.#free(interval_ms, pixels_ms);
    if (free < this.#step) {
      this.#take(free, now_ms);
      return;
    }
    if (this.#step === 0) return;
    const more = (this.#steps[this.#step - 1] / this.scale) ** 2;
    // With a picture of each pose or frame, none could come sooner.
    const least_ms = rate_hz < kCauseShare * causes_hz ? interval_ms : 0;
    const isPromised = Math.max(pixels_ms * more, least_ms) * kPromised * wanted_hz <= 1000;
    if (isPromised && now_ms >= this.#held_until_ms) this.#take(this.#step - 1, now_ms);
  }

  // The largest size that costs next to nothing.
  #free(interval_ms, pixels_ms) {
    const steps = this.#steps;
    let step = this.#step;
    while (step > 0 &&
           pixels_ms * ((steps[step - 1] / this.scale) ** 2 - 1) <= kWorthShare * interval_ms) {
      --step;
    }
    return step;
  }

  // Pictures come too slowly, so far apart.
  #notePace(interval_ms, now_ms) {
    const pace = this.#paces[this.#motion] ??= new PixelCost();
    pace.note(this.#pixels, interval_ms, now_ms);
  }

  // The largest size that promises the rate. None that saves nothing: then the time goes elsewhere.
  #lower({interval_ms, pixels_ms, wanted_hz}) {
    const steps = this.#steps;
    const promised_ms = (step) =>
        interval_ms - pixels_ms + pixels_ms * (steps[step] / this.scale) ** 2;
    let found = Math.min(this.#step, steps.length - 1);
    while (found + 1 < steps.length && promised_ms(found) * wanted_hz > 1000 &&
           promised_ms(found + 1) < (1 - kWorthShare) * promised_ms(found)) {
      ++found;
    }
    return found;
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
