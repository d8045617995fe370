// SPDX-License-Identifier: Apache-2.0
// The ways to look at a display: one at a time, chosen by radio buttons, keys or the address.

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

  // By name; what is no mode is the first.
  choose(name) {
    const radio = this.radios.find(({value}) => value === name) ?? this.radios[0];
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
