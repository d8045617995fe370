// SPDX-License-Identifier: Apache-2.0
// Looking around by tilting the device, where the browser says how it is held.
import {allow} from './allowed.js';

const kRange_deg = 40;  // from one end of the cone to the other

export class Tilt {
  #neutral_deg = null;  // how it was held when tilting began, in the middle of the cone

  // onTilt(position): 0 = left, 1 = right. The button appears where there is something to ask for.
  constructor(button, onTilt) {
    this.button = button;
    this.onTilt = onTilt;
    button.addEventListener('click', () => this.#toggle());
    const event = window.DeviceOrientationEvent;
    if (!event || !window.isSecureContext) return;
    // A frame of another page has to be allowed to know; where it is not, asking is an error.
    if (document.featurePolicy?.allowsFeature('accelerometer') === false) return;
    // Where it is asked for by a touch alone, no event comes before.
    if (event.requestPermission && matchMedia('(any-pointer: coarse)').matches) {
      button.hidden = false;
      return;
    }
    const offer = ({gamma}) => {
      if (gamma === null) return;  // computers tell that they know nothing
      button.hidden = false;
      window.removeEventListener('deviceorientation', offer);
    };
    window.addEventListener('deviceorientation', offer);
  }

  async #toggle() {
    if (this.button.getAttribute('aria-pressed') === 'true') {
      window.removeEventListener('deviceorientation', this.#move);
      this.button.setAttribute('aria-pressed', 'false');
      return;
    }
    const event = window.DeviceOrientationEvent;
    const permission = await event.requestPermission?.().catch(() => 'denied');
    if (permission && permission !== 'granted') {
      allow(this.button, 'The browser was told not to say how the device is held.');
      return;
    }
    this.#neutral_deg = null;
    this.button.setAttribute('aria-pressed', 'true');
    window.addEventListener('deviceorientation', this.#move);
  }

  // Turned with its right edge away, the device shows itself to an eye further left.
  #move = ({beta, gamma}) => {
    if (gamma === null) return;
    const angle_deg = screen.orientation?.angle ?? 0;
    const turned_deg = {0: gamma, 90: beta, 180: -gamma, 270: -beta}[angle_deg] ?? gamma;
    this.#neutral_deg ??= turned_deg;
    this.onTilt(0.5 - (turned_deg - this.#neutral_deg) / kRange_deg);
  };
}
