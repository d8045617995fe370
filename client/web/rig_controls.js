// SPDX-License-Identifier: Apache-2.0
// Moves the eye's rig by pointer, wheel, fingers and keys. The eye's place in the cone is not
// theirs (look.js).

const kTurn_rad = Math.PI;     // that a drag over the whole canvas turns
const kWheelStep = 0.0012;     // of the focal distance a px of wheel
const kKeyStep = 0.05;         // of the focal distance
const kKeyTurn_rad = Math.PI / 36;

export class RigControls {
  #rig;
  #points = new Map();  // by pointer: {x, y}
  #onMove;
  active = false;

  // onMove(): the rig is elsewhere
  constructor(canvas, rig, onMove) {
    this.#rig = rig;
    this.#onMove = onMove;
    canvas.addEventListener('pointerdown', (event) => this.#down(event));
    canvas.addEventListener('pointermove', (event) => this.#drag(event));
    for (const end of ['pointerup', 'pointercancel', 'lostpointercapture']) {
      canvas.addEventListener(end, ({pointerId}) => this.#points.delete(pointerId));
    }
    // Passive listeners could not keep the page from scrolling.
    for (const kind of ['touchstart', 'touchmove']) {
      canvas.addEventListener(kind, (event) => this.#claim(event), {passive: false});
    }
    canvas.addEventListener('wheel', (event) => this.#wheel(event), {passive: false});
    canvas.addEventListener('keydown', (event) => this.#key(event));
    canvas.addEventListener('dblclick', () => this.#reset());
  }

  // One finger scrolls the page, several move the eye.
  #claim(event) {
    if (this.active && event.touches.length > 1 && event.cancelable) event.preventDefault();
  }

  #down(event) {
    if (!this.active || (event.pointerType === 'mouse' && event.button !== 0)) return;
    this.#points.set(event.pointerId, {x: event.clientX, y: event.clientY});
    event.target.setPointerCapture(event.pointerId);
  }

  #drag(event) {
    const before = this.#points.get(event.pointerId);
    if (!this.active || !before) return;
    const now = {x: event.clientX, y: event.clientY};
    this.#points.set(event.pointerId, now);
    const {clientWidth: width, clientHeight: height} = event.target;
    const [right, up] = [(now.x - before.x) / width, (before.y - now.y) / height];
    if (this.#points.size === 2) this.#pinch(event, before, now, right, up);
    else if (this.#points.size === 3) this.#turn(right / 3, up / 3);  // each finger turns a third
    else if (event.pointerType !== 'mouse') return;
    else if (event.shiftKey) this.#rig.pan(-right, -up);
    else this.#turn(right, up);
    this.#onMove();
  }

  // right, up: of a drag, in shares of the canvas
  #turn(right, up) {
    this.#rig.orbit(-right * kTurn_rad, -up * kTurn_rad / 2);
  }

  // Two fingers: apart is a step forward, together a pan.
  #pinch(event, before, now, right, up) {
    const [, other] = [...this.#points].find(([id]) => id !== event.pointerId);
    const apart = (point) => Math.hypot(point.x - other.x, point.y - other.y);
    const grown = apart(now) / Math.max(1, apart(before));
    this.#rig.step(Math.log(grown));
    this.#rig.pan(-right / 2, -up / 2);
  }

  #wheel(event) {
    if (!this.active) return;
    event.preventDefault();
    this.#rig.step(-event.deltaY * kWheelStep);
    this.#onMove();
  }

  #key(event) {
    if (!this.active || event.ctrlKey || event.altKey || event.metaKey) return;
    const rig = this.#rig;
    const moves = {
      w: () => rig.step(kKeyStep), s: () => rig.step(-kKeyStep),
      a: () => rig.pan(-kKeyStep, 0), d: () => rig.pan(kKeyStep, 0),
      e: () => rig.pan(0, kKeyStep), x: () => rig.pan(0, -kKeyStep),
      ArrowUp: () => rig.orbit(0, kKeyTurn_rad), ArrowDown: () => rig.orbit(0, -kKeyTurn_rad),
      0: () => rig.reset(),
    };
    if (event.shiftKey) {
      moves.ArrowLeft = () => rig.orbit(-kKeyTurn_rad, 0);
      moves.ArrowRight = () => rig.orbit(kKeyTurn_rad, 0);
    }
    const move = moves[event.key] ?? moves[event.key.toLowerCase()];
    if (!move) return;
    event.preventDefault();
    move();
    this.#onMove();
  }

  #reset() {
    if (!this.active) return;
    this.#rig.reset();
    this.#onMove();
  }
}
