// SPDX-License-Identifier: Apache-2.0
// A small chart over time: values stacked on each other, newest at the right, 0 at the bottom.

export class Chart {
  #samples = [];  // each as many values as there are colours; oldest first

  // colors: one a value, in CSS; count: samples across the chart; highest: of the axis, 0 = by the
  // samples; describe(samples): the chart in a sentence, for who does not see it
  constructor(canvas, {colors, count, highest = 0, describe}) {
    Object.assign(this, {canvas, colors, count, highest, describe});
  }

  clear() {
    this.#samples = [];
  }

  push(values) {
    this.#samples.push(values);
    if (this.#samples.length > this.count) this.#samples.shift();
  }

  draw() {
    const {canvas} = this;
    if (canvas.clientWidth === 0) return;  // not shown
    const scale = window.devicePixelRatio || 1;
    const width = canvas.width = Math.round(canvas.clientWidth * scale);
    const height = canvas.height = Math.round(canvas.clientHeight * scale);
    const context = canvas.getContext('2d');
    const sums = this.#samples.map((values) => values.reduce((sum, value) => sum + value, 0));
    const highest = this.highest || 1.15 * Math.max(...sums) || 1;
    const xOf = (index) => width * (1 - (this.#samples.length - index) / this.count);
    const step = width / this.count;
    this.colors.forEach((color, part) => {
      context.fillStyle = color.startsWith('--') ?
          getComputedStyle(canvas).getPropertyValue(color) : color;
      this.#samples.forEach((values, index) => {
        const below = values.slice(0, part).reduce((sum, value) => sum + value, 0);
        const top = height * (1 - (below + values[part]) / highest);
        const bottom = height * (1 - below / highest);
        context.fillRect(xOf(index), top, step + 0.5, bottom - top);
      });
    });
    const text = this.#samples.length ? this.describe(this.#samples) : 'nothing yet';
    if (canvas.getAttribute('aria-label') !== text) canvas.setAttribute('aria-label', text);
  }
}

// Text for a span of numbers: "3 to 7, now 5".
export function spanText(values, digits) {
  const [low, high] = [Math.min(...values), Math.max(...values)];
  return `${low.toFixed(digits)} to ${high.toFixed(digits)}, now ${values.at(-1).toFixed(digits)}`;
}
