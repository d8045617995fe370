// SPDX-License-Identifier: Apache-2.0
// The ways to look at a display: one at a time, chosen by radio buttons, keys or the address.
import {allow} from './allowed.js';

const byId = (id) => document.getElementById(id);

export class Modes {
  // handlers: by mode, {enter(), leave()}, either may be missing; onMode(name): entered
  constructor(handlers, onMode) {
    this.handlers = handlers;
    this.onMode = onMode;
    this.mode = null;
    this.radios = [...byId('modes').querySelectorAll('input')];
    byId('modes').addEventListener('change', ({target}) => this.choose(target.value));
  }

  // To some names, of which the first is the usual one. reason: why the others are not there
  restrict(names, reason) {
    this.usual = names[0];
    for (const radio of this.radios) allow(radio, names.includes(radio.value) ? '' : reason);
    if (this.mode && !names.includes(this.mode)) this.choose(this.usual);
  }

  // By name; what is no mode here is the usual one.
  choose(name) {
    const find = (wanted) => this.radios.find(({value, disabled}) => value === wanted && !disabled);
    const radio = find(name) ?? find(this.usual);
    radio.checked = true;
    if (radio.value === this.mode) return;
    this.handlers[this.mode]?.leave?.();
    this.mode = radio.value;
    document.documentElement.dataset.mode = this.mode;
    for (const part of document.querySelectorAll('[data-for]')) {
      part.hidden = !part.dataset.for.split(' ').includes(this.mode);
    }
    this.handlers[this.mode]?.enter?.();
    this.onMode(this.mode);
  }
}
