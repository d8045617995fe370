// SPDX-License-Identifier: Apache-2.0
// Single views: one at a time, by number, standing still.
import {allow} from './allowed.js';

const byId = (id) => document.getElementById(id);

export class SingleMode {
  #wanted = null;  // by hand, from 0; null = the middle one
  #view = 0;       // what is shown of it while there are #count views
  #count = 0;

  // onView(number from 0): it is to be shown
  constructor(stage, onView) {
    this.stage = stage;
    this.onView = onView;
    byId('single-view').addEventListener('input', ({target}) => {
      if (target.value !== '') this.#take(target.valueAsNumber);
    });
    byId('single-back').addEventListener('click', () => this.#take(this.#view - 1));
    byId('single-on').addEventListener('click', () => this.#take(this.#view + 1));
    stage.canvas.addEventListener('keydown', (event) => this.#key(event));
  }

  // From 0.
  get view() { return this.#view; }

  enter() {
    this.stage.single = this.#view;
    this.layoutChanged(this.#count);
    this.stage.invalidate();
  }

  leave() {
    this.stage.single = null;
    this.stage.invalidate();
  }

  // How many views there are now; 0 = not known yet.
  layoutChanged(count) {
    this.#count = count;
    byId('single-count').textContent = count ? `of 0–${count - 1}` : 'of –';
    byId('single-view').max = Math.max(0, count - 1);
    if (count && this.stage.single !== null) this.#show(this.#wanted ?? Math.floor(count / 2));
  }

  #key(event) {
    if (this.stage.single === null) return;
    const views = {
      ArrowLeft: this.#view - 1, ArrowRight: this.#view + 1, PageDown: this.#view - 8,
      PageUp: this.#view + 8, Home: 0, End: this.#count - 1,
    };
    if (!(event.key in views)) return;
    event.preventDefault();
    this.#take(views[event.key]);
  }

  #take(view) {
    this.#show(view);
    this.#wanted = this.#view;
  }

  #show(view) {
    this.#view = Math.min(Math.max(0, this.#count - 1), Math.max(0, Math.round(view)));
    allow(byId('single-back'), this.#view === 0 ? 'This is the first view.' : '');
    allow(byId('single-on'), this.#view >= this.#count - 1 ? 'This is the last view.' : '');
    if (document.activeElement !== byId('single-view')) {
      byId('single-view').value = this.#view;
    }
    if (this.stage.single === null) return;
    this.stage.single = this.#view;
    this.onView(this.#view);
    this.stage.invalidate();
  }
}
