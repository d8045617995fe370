// SPDX-License-Identifier: Apache-2.0
// Where the viewer's eye stands, 0 = left, 1 = right: pointer, drag, keys, and at first a gentle
// sway until somebody takes over.

const kSwayPeriod_ms = 7000;
const kSwayTime_ms = 2 * kSwayPeriod_ms;  // then it stands, in the middle, and costs nothing
const kSwayWidth = 0.42;        // of the cone, to either side of the middle
const kFollow_ms = 70;          // time in which the eye comes 1/e closer to where it shall be
const kSettled = 1e-4;          // of the cone; less than a view of the largest quilt
const kKeyStep = 1 / 48;

export class Look {
  #target = 0.5;
  #position = 0.5;
  #last_ms = 0;
  #swayBegin_ms = null;
  #running = false;
  #drag = null;
  #fingers = new Set();
  #active = true;

  // onLook(position, isOnItsWay): also in each frame while it is on its way
  constructor(canvas, slider, onLook) {
    this.onLook = onLook;
    this.slider = slider;
    this.still = matchMedia('(prefers-reduced-motion: reduce)');
    this.swaying = !this.still.matches;
    canvas.addEventListener('pointerdown', (event) => this.#down(event));
    canvas.addEventListener('pointermove', (event) => this.#move(event));
    for (const end of ['pointerup', 'pointercancel']) {
      canvas.addEventListener(end, ({pointerId}) => {
        this.#fingers.delete(pointerId);
        this.#drag = null;
      });
    }
    canvas.addEventListener('keydown', (event) => this.#key(event));
    slider.addEventListener('input', () => this.take(slider.valueAsNumber));
    this.#run();
  }

  // Where it is, or is on its way to.
  get target() { return this.#target; }

  // 0..1; what lies beyond is brought there.
  take(target) {
    this.swaying = false;
    this.#target = Math.min(1, Math.max(0, target));
    this.#run();
  }

  // While another mode is on, the eye stands still.
  set active(isActive) {
    this.#active = isActive;
    if (isActive) this.#run();
  }

  #down(event) {
    if (event.pointerType === 'mouse' || !this.#active) return;
    event.target.setPointerCapture(event.pointerId);
    this.#fingers.add(event.pointerId);
    // Two fingers pan and step (rig_controls.js).
    this.#drag = this.#fingers.size === 1 ? {x: event.clientX, from: this.#target} : null;
  }

  #move(event) {
    if (!this.#active) return;
    const width = event.target.clientWidth;
    if (event.pointerType === 'mouse') {
      if (event.buttons !== 0) return;  // turns about the scene
      this.take((event.clientX - event.target.getBoundingClientRect().left) / width);
    } else if (this.#drag) {
      this.take(this.#drag.from - (event.clientX - this.#drag.x) / width);
    }
  }

  #key(event) {
    if (!this.#active || event.shiftKey) return;
    const steps = {ArrowLeft: -1, ArrowRight: 1, PageDown: -6, PageUp: 6}[event.key];
    const ends = {Home: 0, End: 1}[event.key];
    if (steps === undefined && ends === undefined) return;
    event.preventDefault();
    this.take(ends ?? this.#target + steps * kKeyStep);
  }

  #run() {
    if (this.#running || !this.#active) return;
    this.#running = true;
    this.#last_ms = performance.now();
    requestAnimationFrame((now_ms) => this.#step(now_ms));
  }

  #sway(now_ms) {
    this.#swayBegin_ms ??= now_ms;
    const time_ms = now_ms - this.#swayBegin_ms;
    this.swaying = time_ms < kSwayTime_ms;
    this.#target = 0.5;
    if (!this.swaying) return;
    this.#target += kSwayWidth * Math.sin(2 * Math.PI * time_ms / kSwayPeriod_ms);
  }

  #step(now_ms) {
    if (this.swaying) this.#sway(now_ms);
    const elapsed_ms = Math.max(0, now_ms - this.#last_ms);
    this.#last_ms = now_ms;
    const follow = this.still.matches ? 1 : 1 - Math.exp(-elapsed_ms / kFollow_ms);
    this.#position += (this.#target - this.#position) * follow;
    const settled = !this.swaying && Math.abs(this.#target - this.#position) < kSettled;
    if (settled) this.#position = this.#target;
    if (!this.slider.matches(':active')) this.slider.valueAsNumber = this.#position;
    this.#running = !settled && this.#active;
    this.onLook(this.#position, this.#running);
    if (this.#running) requestAnimationFrame((next_ms) => this.#step(next_ms));
  }
}
