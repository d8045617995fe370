// SPDX-License-Identifier: Apache-2.0
// Controls that change the display while it is watched: focal distance, whether it follows the
// content, view cone, reflections.
import {allow, kNoPicture} from './allowed.js';

const kThrottle_ms = 120;
const kFollow_s = 1;
const kDegPerRad = 180 / Math.PI;
const kBounces = 2;  // what mirrors show of other mirrors, too

// Controls of displays whose views are spread.
const kSpread = ['focus', 'follow', 'cone', 'reset'];
const kNoPlane = 'This display has no focal plane and no cone: its views are not spread.';
const kAtRest = 'Focus and cone are as the display has them.';

const byId = (id) => document.getElementById(id);

export class DisplayControls {
  #neutral_m = 0;  // focal distance in the middle of the slider
  #isPending = false;
  #timer = 0;
  #chosen = null;

  // onChange(): the display is another
  constructor(onChange) {
    this.onChange = onChange;
    for (const id of kSpread) allow(byId(id), kNoPicture);
    byId('focus').addEventListener('input', ({target}) => {
      const focus_m = this.#neutral_m * 2 ** target.valueAsNumber;
      this.#write('focus', `${focus_m.toFixed(2)} m`);
      this.take({focal_distance_m: Number(focus_m.toPrecision(4))});
    });
    byId('cone').addEventListener('input', ({target}) => {
      this.#write('cone', `${target.value}°`);
      this.take({view_cone_rad: target.valueAsNumber / kDegPerRad});
    });
    byId('follow').addEventListener('change', ({target}) => {
      this.#change({focus_following_s: target.checked ? kFollow_s : null});
    });
    byId('reset').addEventListener('click', () => {
      this.forget();
      this.take({focal_distance_m: null, view_cone_rad: null});
    });
    byId('reflections').addEventListener('change', ({target}) => {
      this.#change({'effects.reflection': target.checked ? {bounces: kBounces} : null});
    });
  }

  // DisplayDocument of the chosen display
  showChosen(chosen) {
    this.#chosen = chosen;
    byId('follow').checked = chosen.get('focus_following_s') !== undefined;
    byId('reflections').checked = chosen.get('effects.reflection') !== undefined;
  }

  // Sets the sliders: fields of the kind. They do not stay in the address.
  take(fields) {
    const {kind} = this.#chosen;
    const changes = Object.entries(fields).map(([name, value]) => [`${kind}.${name}`, value]);
    this.#change(Object.fromEntries(changes), false);
    this.#offerReset();
  }

  // There is something to take back where the display says either.
  #offerReset() {
    const {kind} = this.#chosen;
    const isMoved = ['focal_distance_m', 'view_cone_rad'].some(
        (name) => this.#chosen.get(`${kind}.${name}`) !== undefined);
    allow(byId('reset'), isMoved ? '' : kAtRest);
  }

  // Another stream or device: its focal distance becomes the middle of the slider.
  forget() {
    this.#neutral_m = 0;
  }

  // Shows the values of the newest atlas.
  show(layout) {
    // Colour with depth has neither: its views are one.
    const isSpread = layout.view_cone_rad > 0;
    for (const id of kSpread) allow(byId(id), isSpread ? '' : kNoPlane);
    if (!isSpread) return;
    this.#offerReset();
    const sliding = document.querySelector('#focus:active, #cone:active');
    if (this.#isPending || sliding) return;
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
  #change(changes, isKept = true) {
    this.#chosen.set(changes, isKept);
    this.#isPending = true;
    if (this.#timer) return;
    this.#send();
    this.#timer = setTimeout(() => {
      this.#timer = 0;
      this.#send();
    }, kThrottle_ms);
  }

  #send() {
    if (this.#isPending) this.onChange();
    this.#isPending = false;
  }
}
