// SPDX-License-Identifier: Apache-2.0
// The button that enters a headset, where the browser has one, and leaves it again.
import {notice} from './notice.js';
import {XrStay} from './xr_session.js';

export class XrButton {
  #stay = null;

  // handlers: asked(eye_size, count), what /ws is asked for; onEnter(), onLeave(); onShown() of
  // XrStay
  constructor(button, handlers) {
    this.button = button;
    this.handlers = handlers;
    // A frame of another page has to be allowed to; where it is not, asking is an error.
    if (document.featurePolicy?.allowsFeature('xr-spatial-tracking') === false) return;
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
        ...this.handlers,
        onProblem: (sentence) => notice(sentence, 'bad'),
        onEnd: (problem) => this.#leave(problem),
      });
      this.button.textContent = 'Leave VR';
      this.handlers.onEnter();
    } catch (error) {
      notice(`VR did not begin: ${error.message}`, 'bad');
    }
    this.button.disabled = false;
  }

  #leave(problem) {
    this.#stay = null;
    this.button.textContent = 'Enter VR';
    this.handlers.onLeave();
    if (problem) notice(problem, 'bad');
  }
}
