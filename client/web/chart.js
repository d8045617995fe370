// SPDX-License-Identifier: Apache-2.0
// A small chart over time: values stacked on each other, newest at the right, 0 at the bottom, with
// its scale beside it.

const kRoundSteps = [1, 2, 5, 10];

// The round number, 1, 2 or 5 times a power of ten, that a value still fits below.
function roundedUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * kRoundSteps.find((step) => step * power >= value * (1 - 1e-9));
}

function addLabel(place, name, text = '') {
  const label = document.createElement('span');
  label.className = `plot-${name}`;
  label.textContent = text;
  label.ariaHidden = true;  // the chart says it in its own sentence
  place.append(label);
  return label;
}

export class Chart {
  #samples = [];  // each as many values as there are colours; oldest first
  #top = null;    // the label of the scale's upper end

  // colors: one a value, in CSS; count: samples across the chart; highest: of the axis, 0 = by the
  // samples; unit: of the values; begin: how far back the left end is, in words;
  // describe(samples): the chart in a sentence, for who does not see it
  constructor(canvas, {colors, count, highest = 0, unit, begin, describe}) {
    Object.assign(this, {canvas, colors, count, highest, unit, describe});
    const place = document.createElement('div');
    place.className = 'plot';
    canvas.replaceWith(place);
    this.#top = addLabel(place, 'top');
    addLabel(place, 'zero', '0');
    place.append(canvas);
    addLabel(place, 'begin', begin);
    addLabel(place, 'end', 'now');
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
    const highest = this.highest || roundedUp(Math.max(...sums, 0) || 1);
    this.#write(highest);
    const colorOf = (color) => color.startsWith('--') ?
      getComputedStyle(canvas).getPropertyValue(color) : color;
    const xOf = (index) => width * (1 - (this.#samples.length - index) / this.count);
    const step = width / this.count;
    this.colors.forEach((color, part) => {
      context.fillStyle = colorOf(color);
      this.#samples.forEach((values, index) => {
        const below = values.slice(0, part).reduce((sum, value) => sum + value, 0);
        const top = height * (1 - (below + values[part]) / highest);
        const bottom = height * (1 - below / highest);
        context.fillRect(xOf(index), top, step + 0.5, bottom - top);
      });
    });
    context.fillStyle = colorOf('--edge');  // at the ends and the half of the scale
    for (const at of [0, 0.5, 1]) context.fillRect(0, at * (height - scale), width, scale);
  }

  #write(highest) {
    const scaleText = `${highest}${this.unit}`;
    if (this.#top.textContent !== scaleText) this.#top.textContent = scaleText;
    const text = this.#samples.length ? this.describe(this.#samples) : 'nothing yet';
    if (this.canvas.getAttribute('aria-label') !== text) {
      this.canvas.setAttribute('aria-label', text);
    }
  }
}

// Text for a span of numbers: "3 to 7, now 5".
export function spanText(values, digits) {
  const [low, high] = [Math.min(...values), Math.max(...values)];
  return `${low.toFixed(digits)} to ${high.toFixed(digits)}, now ${values.at(-1).toFixed(digits)}`;
}
