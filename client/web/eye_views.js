// SPDX-License-Identifier: Apache-2.0
// Which few of a display's views are asked for: those around the eye, and ahead of it.

const kSpeedWindow_ms = 120;   // of eye positions that its speed is taken from
const kAheadFirst_ms = 100;    // until an answer was seen
const kAheadMax_ms = 400;      // a slower answer is not led further
const kSmoothing = 0.3;        // weight of the newest answer in a running mean
const kAnswer_ms = 5000;       // by then another may be asked for

export class EyeViews {
  #track = [];     // {time_ms, view}, oldest first
  #asked_ms = null;  // an answer is awaited
  #ahead_ms = kAheadFirst_ms;
  #still = 0;  // the timer of onStill

  // onMove(): other views are wanted. onStill(): the eye has moved, and no more since: look() where
  // it is
  constructor(onMove, onStill) {
    this.onMove = onMove;
    this.onStill = onStill;
    this.total = 0;   // of the whole display
    this.count = 1;   // asked for at once
    this.first = 0;   // from 0
  }

  // How many there are, and how many of them are asked for at once.
  spread(total, count) {
    this.total = total;
    this.count = Math.min(count, total);
    this.first = this.#blockOf(this.#track.at(-1)?.view ?? (total - 1) / 2);
  }

  // The part of the cone that they share, as a QuiltDisplay says it.
  get part() {
    return {cone_begin: this.first / this.total, cone_end: (this.first + this.count) / this.total};
  }

  // The eye is at a view, a number from 0, or between two. isSteady: it will stay.
  look(view, now_ms, isSteady = false) {
    if (isSteady) this.#track = [];
    this.#track.push({time_ms: now_ms, view});
    this.#track = this.#track.filter(({time_ms}) => now_ms - time_ms <= kSpeedWindow_ms);
    // Nothing else tells that it has come to a stop, and that what lies ahead is not wanted.
    clearTimeout(this.#still);
    if (this.#speed() !== 0) this.#still = setTimeout(this.onStill, kSpeedWindow_ms + 1);
    if (this.#asked_ms !== null && now_ms - this.#asked_ms < kAnswer_ms) return;
    this.#asked_ms = null;
    const block = this.#wanted(view);
    if (block === this.first || this.total === 0) return;
    this.first = block;
    this.onMove();
  }

  // Marks the wanted block as asked for; nothing else is asked for until it is answered.
  noteAsked(now_ms) {
    this.#asked_ms = now_ms;
  }

  noteAnswered(now_ms) {
    if (this.#asked_ms === null) return;
    const taken_ms = Math.min(now_ms - this.#asked_ms, kAheadMax_ms);
    this.#ahead_ms += (taken_ms - this.#ahead_ms) * kSmoothing;
    this.#asked_ms = null;
  }

  // Another connection answers nothing that was asked before.
  forget() {
    this.#asked_ms = null;
  }

  // The next block to ask for. If the eye looks at none soon that is missing and not on its way,
  // the block ahead.
  #wanted(view) {
    const ahead = this.#clamp(view + this.#speed() * this.#ahead_ms);
    const holds = (at) => at > this.first - 0.5 && at < this.first + this.count - 0.5;
    return holds(view) && holds(ahead) ? this.first : this.#blockOf(ahead);
  }

  // Views per ms.
  #speed() {
    const [first, last] = [this.#track[0], this.#track.at(-1)];
    const span_ms = last.time_ms - first.time_ms;
    return span_ms > 0 ? (last.view - first.view) / span_ms : 0;
  }

  #clamp(view) { return Math.min(this.total - 1, Math.max(0, view)); }

  // Blocks stand in fixed places, one view over the next, so that viewers share them.
  #blockOf(view) {
    const step = Math.max(1, this.count - 1);
    const first = Math.round((this.#clamp(view) - (this.count - 1) / 2) / step) * step;
    return Math.min(this.total - this.count, Math.max(0, first));
  }
}
