// SPDX-License-Identifier: Apache-2.0
// The button that enters a headset, where the browser has one, and leaves it again.
import {notice} from './notice.js';
import {XrStay} from './xr_session.js';

export class XrButton {
  #stay = null;

  // asked(eye_size, count): what /ws is asked for; onEnter(), onLeave()
  constructor(button, asked, onEnter, onLeave) {
    this.button = button;
    this.asked = asked;
    this.onEnter = onEnter;
    this.onLeave = onLeave;
    button.addEventListener('click', () => this.#press());
    navigator.xr?.addEventListener?.('devicechange', () => this.#offer());
    this.#offer();
  }

  async #offer() {
    // Pages beyond loopback need TLS for a headset; without it there is no navigator.xr.
    const isOffered = await navigator.xr?.isSessionSupported('immersive-vr').catch(() => false);
    this.button.hidden = !isOffered;
  }

  async #press() {
    if (this.#stay) {
      await this.#stay.leave();
      return;
    }
    this.button.disabled = true;
    try {
      this.#stay = await XrStay.begin(navigator.xr, {
        asked: this.asked,
        onProblem: (sentence) => notice(sentence, 'bad'),
        onEnd: () => this.#leave(),
      });
      this.button.textContent = 'Leave VR';
      this.onEnter();
    } catch (error) {
      notice(`VR did not begin: ${error.message}`, 'bad');
    }
    this.button.disabled = false;
  }

  #leave() {
    this.#stay = null;
    this.button.textContent = 'Enter VR';
    this.onLeave();
  }
}
