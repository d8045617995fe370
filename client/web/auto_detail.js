// SPDX-License-Identifier: Apache-2.0
// Chooses how finely the display is traced: as finely as a moving picture allows, and one that
// stands still in full detail.
import {kQuiltSteps} from './detail_steps.js';

const kStepsDownMax = 2;  // at once: a judgement while a server starts is a bad one

// Atlases shown. Fewer than eight are no motion; the ninth keeps eight when the rate wavers.
const kWanted_hz = 9;
// More detail is taken when it promises this much: what is taken must not be given back.
const kPromised_hz = 10;
// A viewer that shows four of five published frames is not slow: the publisher is.
const kPublishedShare = 0.8;
// A step down that saves less is not taken: the time goes elsewhere. Share of an atlas's time.
const kWorthShare = 0.15;

const kWindow_ms = 8000;      // atlases that a judgement is made of
const kFullShare = 0.8;       // of the window, at least
const kHurry_ms = 1500;       // after a start, a step down, or when the rate is hopeless
const kHopelessShare = 0.6;   // of the wanted rate
const kAnswer_ms = 10_000;    // by then the server has answered a change, or never will
const kStart = 0.25;          // of a quilt: a slow server's first atlas comes soon

// How long more detail is not tried after less was needed: longer with every try that failed.
const kHoldFirst_ms = 12_000;
const kHoldMax_ms = 300_000;
const kProven_ms = 240_000;  // a try that lasted as long has not failed

// A picture stands still if none follows for as long, and for so many times what this one took to
// make, and to come after the one before: the next is not just late.
const kStill_ms = 1000;
const kStillTimes = 3;
// Pictures that come in shorter intervals are a motion.
const kMotion_ms = 2000;

const kMsPerNs = 1e-6;

export class AutoDetail {
  #steps = [];
  #index = 0;
  #shown = [];  // {time_ms, frame, fixed_ms, traced_ms}, oldest first, all of this detail
  #size = '';
  #left = {size: '', until_ms: 0};  // the detail before: its atlases are still on their way
  #isSettled = false;               // no hurry: this detail was judged, or is one to be proven
  #raised_ms = null;                // the newest try of more detail, until it is given back
  #held_until_ms = -Infinity;
  #hold_ms = kHoldFirst_ms;
  #moving = null;  // the step before a picture stood still
  #interval_ms = 0;  // between the newest two frames, whatever the step

  // onChange(): another step
  constructor(onChange) {
    this.onChange = onChange;
    this.begin(kQuiltSteps, kQuiltSteps.indexOf(kStart));
  }

  // A share of a view's width and height.
  get detail() { return this.#steps[this.#index]; }

  // Other steps, from the most detail to the least, and which of them is the first.
  begin(steps, index) {
    this.#steps = steps;
    this.#index = index;
    this.#moving = null;
    this.#raised_ms = null;
    this.#held_until_ms = -Infinity;
    this.#hold_ms = kHoldFirst_ms;
    this.#left.size = '';
    this.#size = '';
    this.#shown = [];
    this.#isSettled = false;
  }

  // Later requests may take many times longer, so the first atlas asks for little.
  startLow() {
    this.#index = this.#steps.length - 1;
    this.#leave(performance.now());
    this.#isSettled = false;
  }

  // Time that passed without the server being asked says nothing about it.
  restart() {
    this.#shown = [];
  }

  // An atlas came to be seen.
  note({times, layout, frame_number}, now_ms) {
    const size = `${layout.size.width}x${layout.size.height}`;
    if (size === this.#left.size && now_ms < this.#left.until_ms) return;
    this.#left.size = '';
    const shown = {
      time_ms: now_ms,
      frame: Number(frame_number),
      fixed_ms: (times.retime_ns + times.upload_ns + times.build_ns) * kMsPerNs,
      traced_ms: (times.trace_ns + times.encode_ns) * kMsPerNs,
    };
    const before = this.#shown.at(-1);
    // Other views of the same frame: no motion.
    if (size === this.#size && shown.frame === before?.frame) return;
    const isOther = size !== this.#size || shown.frame < before?.frame;
    this.#interval_ms = before && !isOther ? now_ms - before.time_ms : this.#interval_ms;
    this.#size = size;
    this.#shown = isOther ? [] : this.#shown;
    this.#shown.push(shown);
    // A slow server's newest two count however old they are.
    this.#shown = this.#shown.filter(({time_ms}, index, all) =>
        now_ms - time_ms <= kWindow_ms || index >= all.length - 2);
    this.#judge(now_ms);
  }

  // Time passes: to be called several times a second, as long as the server answers. isLast: the
  // publisher is gone.
  look(now_ms, isLast = false) {
    const newest = this.#shown.at(-1);
    if (!newest || this.#index === 0) return;
    const usual_ms = Math.max(newest.fixed_ms + newest.traced_ms, this.#interval_ms);
    const still_ms = Math.max(kStill_ms, kStillTimes * usual_ms);
    if (!isLast && now_ms - newest.time_ms < still_ms) return;
    this.#moving = this.#index;
    this.#take(0, now_ms);
  }

  #judge(now_ms) {
    const measured = this.#measure();
    if (!measured) return;
    const {rate_hz, wanted_hz, span_ms} = measured;
    const isHopeless = rate_hz < kHopelessShare * wanted_hz;
    if (span_ms < (this.#isSettled && !isHopeless ? kFullShare * kWindow_ms : kHurry_ms)) return;
    this.#isSettled = true;
    const index = this.#index;
    const better = rate_hz < wanted_hz ? this.#lower(index, measured)
        : now_ms >= this.#held_until_ms ? this.#higher(index, measured) : index;
    // It moves again, and not with all detail: how much does is not looked for once more.
    const known = better > index && this.#moving ? this.#moving : 0;
    const isMoving = rate_hz * kMotion_ms > 1000;
    if (isMoving || better !== index) this.#moving = null;
    if (better !== index) this.#take(Math.max(better, known), now_ms);
  }

  // Over the atlases noted; null as long as they say nothing.
  #measure() {
    const [first, last] = [this.#shown[0], this.#shown.at(-1)];
    const span_ms = last.time_ms - first.time_ms;
    if (span_ms <= 0) return null;
    const count = this.#shown.length - 1;
    const rate_hz = count * 1000 / span_ms;
    const published_hz = (last.frame - first.frame) * 1000 / span_ms;
    const mean = (key) => this.#shown.reduce((sum, atlas) => sum + atlas[key], 0) / (count + 1);
    const [fixed_ms, traced_ms] = [mean('fixed_ms'), mean('traced_ms')];
    return {
      span_ms,
      rate_hz,
      wanted_hz: Math.min(kWanted_hz, kPublishedShare * published_hz),
      // Stages of several frames overlap: an atlas takes no longer than the time to the next.
      atlas_ms: Math.min(fixed_ms + traced_ms, 1000 / rate_hz),
      tracedShare: traced_ms / Math.max(fixed_ms + traced_ms, kMsPerNs),
    };
  }

  // Tracing and encoding grow with the number of pixels, the rest does not.
  #promised_ms(index, atlas_ms, tracedShare) {
    const pixels = (this.#steps[index] / this.#steps[this.#index]) ** 2;
    return atlas_ms * (1 - tracedShare + tracedShare * pixels);
  }

  // The most detail that promises the wanted rate; none where less of it saves nothing.
  #lower(index, {rate_hz, wanted_hz, tracedShare}) {
    const lowest = Math.min(index + kStepsDownMax, this.#steps.length - 1);
    const promised_ms = (at) => this.#promised_ms(at, 1000 / rate_hz, tracedShare);
    let better = index;
    while (better < lowest && promised_ms(better) * wanted_hz > 1000 &&
           promised_ms(better + 1) < (1 - kWorthShare) * promised_ms(better)) {
      ++better;
    }
    return better;
  }

  #higher(index, {atlas_ms, tracedShare}) {
    let better = index;
    while (better > 0 &&
           this.#promised_ms(better - 1, atlas_ms, tracedShare) * kPromised_hz <= 1000) {
      --better;
    }
    return better;
  }

  #take(index, now_ms) {
    const isRaise = index < this.#index;
    if (isRaise) {
      this.#raised_ms = now_ms;
    } else {
      if (this.#raised_ms !== null) {
        const hasFailed = now_ms - this.#raised_ms < kProven_ms;
        this.#hold_ms = hasFailed ? Math.min(2 * this.#hold_ms, kHoldMax_ms) : kHoldFirst_ms;
      }
      this.#raised_ms = null;
      this.#held_until_ms = now_ms + this.#hold_ms;
    }
    this.#index = index;
    this.#leave(now_ms);
    this.#isSettled = isRaise;
    this.onChange();
  }

  // The result of the step before says nothing about this one.
  #leave(now_ms) {
    this.#left = {size: this.#size, until_ms: now_ms + kAnswer_ms};
    this.#shown = [];
  }
}
