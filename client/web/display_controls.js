// SPDX-License-Identifier: Apache-2.0
// What changes the display while it is watched: focal distance, whether it follows the content,
// view cone, reflections.
import {keepInAddress, pageParameters} from './address.js';

const kThrottle_ms = 120;
const kFollow_s = '1';
const kDegPerRad = 180 / Math.PI;
const kBounces = '2';  // what mirrors show of other mirrors, too

const byId = (id) => document.getElementById(id);

export class DisplayControls {
  #neutral_m = 0;  // focal distance in the middle of the slider
  #pending = null;
  #timer = 0;

  // onChange({focus_m, focus_follow_s, cone_deg, reflections}): parameters of /ws; null = the
  // default
  constructor(onChange) {
    this.onChange = onChange;
    byId('focus').addEventListener('input', ({target}) => {
      const focus_m = this.#neutral_m * 2 ** target.valueAsNumber;
      this.#write('focus', `${focus_m.toFixed(2)} m`);
      this.#change({focus_m: focus_m.toPrecision(4)});
    });
    byId('cone').addEventListener('input', ({target}) => {
      this.#write('cone', `${target.value}°`);
      this.#change({cone_deg: target.value});
    });
    byId('follow').addEventListener('change', ({target}) => {
      const following = {focus_follow_s: target.checked ? kFollow_s : null};
      keepInAddress(following);
      this.#change(following);
    });
    byId('reset').addEventListener('click', () => {
      this.forget();
      this.#change({focus_m: null, cone_deg: null});
    });
    byId('reflections').checked = pageParameters().has('reflections');
    byId('reflections').addEventListener('change', ({target}) => {
      const reflections = target.checked ? kBounces : null;
      keepInAddress({reflections});
      this.#change({reflections});
    });
  }

  // As if the sliders had been moved there.
  take(parameters) {
    this.#change(parameters);
  }

  // Another stream or device: its focal distance becomes the middle of the slider.
  forget() {
    this.#neutral_m = 0;
    byId('follow').checked = pageParameters().has('focus_follow_s');
  }

  // What the newest atlas was made with.
  show(layout) {
    // Colour with depth has neither: its views are one.
    const isSpread = layout.view_cone_rad > 0;
    for (const id of ['focus', 'follow', 'cone', 'reset']) byId(id).disabled = !isSpread;
    if (!isSpread) return;
    const sliding = document.querySelector('#focus:active, #cone:active');
    if (this.#pending || sliding) return;
    if (this.#neutral_m === 0) this.#neutral_m = layout.focal_distance_m;
    byId('focus').valueAsNumber = Math.log2(layout.focal_distance_m / this.#neutral_m);
    byId('cone').valueAsNumber = layout.view_cone_rad * kDegPerRad;
    this.#write('focus', `${layout.focal_distance_m.toFixed(2)} m`);
    this.#write('cone', `${(layout.view_cone_rad * kDegPerRad).toFixed(0)}°`);
  }

  #write(id, text) {
    byId(`${id}-value`).textContent = text;
  }

  // The first change goes at once, further ones joined.
  #change(parameters) {
    this.#pending = {...this.#pending, ...parameters};
    if (this.#timer) return;
    this.#send();
    this.#timer = setTimeout(() => {
      this.#timer = 0;
      this.#send();
    }, kThrottle_ms);
  }

  #send() {
    if (this.#pending) this.onChange(this.#pending);
    this.#pending = null;
  }
}
