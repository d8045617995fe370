// SPDX-License-Identifier: Apache-2.0
// Whether the pictures move: a still has no frame rate, and no latency that means anything.

const kStill_ms = 2000;
// The next picture of a slow stream is not just late.
const kStillTimes = 3;

export class Stillness {
  #moment = null;   // what the newest picture shows, as text
  #since_ms = 0;    // when the first picture of it came
  #usual_ms = 0;    // from one moment to the next, or to make a picture
  #count = 0;       // moments

  // Another stream.
  clear() {
    this.#moment = null;
    this.#usual_ms = 0;
    this.#count = 0;
  }

  // A picture came. Whether it shows another moment than the one before, that this page has waited
  // for: the first one of a stream may have stood for any time.
  note({timing, frame_number, shown_time_ns, times}, now_ms) {
    const moment = timing === 'held' && this.#moment !== null ? this.#moment :
      `${frame_number} ${shown_time_ns}`;
    const isAnother = moment !== this.#moment;
    const made_ms = (times.trace_ns + times.encode_ns) / 1e6;
    if (isAnother) {
      this.#usual_ms = Math.max(made_ms, this.#count > 0 ? now_ms - this.#since_ms : 0);
      this.#moment = moment;
      this.#since_ms = now_ms;
      this.#count++;
    }
    return isAnother && this.#count > 1;
  }

  isStill(now_ms) {
    return this.#count > 0 &&
        now_ms - this.#since_ms > Math.max(kStill_ms, kStillTimes * this.#usual_ms);
  }
}
