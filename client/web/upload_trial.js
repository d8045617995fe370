// SPDX-License-Identifier: Apache-2.0
// Which of two ways brings pictures of a video to where they are drawn. Both are measured with the
// first atlases; the faster one is kept.

const kTrials = 2;  // of each way. The first one also allocates and compiles, and does not count

export class UploadTrial {
  #times_ms = {};
  #kept = '';

  // names: of the ways
  constructor(names) {
    for (const name of names) this.#times_ms[name] = [];
  }

  // '' while it is being measured.
  get kept() { return this.#kept; }

  // For the next atlas.
  get next() {
    if (this.#kept) return this.#kept;
    const count = (name) => this.#times_ms[name].length;
    return Object.keys(this.#times_ms).reduce(
        (least, name) => count(name) < count(least) ? name : least);
  }

  // An atlas took so long in a way.
  note(name, time_ms) {
    if (this.#kept) return;
    this.#times_ms[name].push(time_ms);
    const all = Object.entries(this.#times_ms);
    if (all.some(([, times]) => times.length < kTrials)) return;
    const best_ms = (times) => Math.min(...times.slice(1));
    [this.#kept] = all.reduce((best, way) => best_ms(way[1]) < best_ms(best[1]) ? way : best);
  }

  // A way that does not serve here.
  ruleOut(name) {
    delete this.#times_ms[name];
    [this.#kept] = Object.keys(this.#times_ms);
  }
}
