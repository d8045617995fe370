// SPDX-License-Identifier: Apache-2.0
// Steps of somebody in a headset, by the sticks of the controllers: where the room of the headset
// stands in the display's coordinates.
import {add, multiply, rotate, subtract, turn} from './view_camera.js';

const kUp = [0, 1, 0];
const kSpeed = 0.5;            // of the focal distance, a second
const kSnap_rad = Math.PI / 6;  // one turn of the right stick
const kDead = 0.15;            // of a stick that is let go
const kSnap = 0.7;             // of a stick that turns
const kReleased = 0.3;
const kPauseMax_s = 0.1;       // a longer one moves nobody

const beyond = (value) => Math.abs(value) < kDead ? 0 : value;

export class XrWalk {
  #offset_m = [0, 0, 0];
  #orientation = [0, 0, 0, 1];
  #time_s = null;
  #mayTurn = true;

  // A pose of the headset's space, {position, orientation}, in the display's coordinates.
  placed({position, orientation}) {
    return {
      position: add(this.#offset_m, rotate(this.#orientation, position)),
      orientation: multiply(this.#orientation, orientation),
    };
  }

  // sources: XRInputSources; head: its pose in the headset's space; focal_m: how large things are
  step(sources, head, focal_m, time_s) {
    const pause_s = Math.min(kPauseMax_s, Math.max(0, time_s - (this.#time_s ?? time_s)));
    this.#time_s = time_s;
    for (const {gamepad, handedness} of sources) {
      if (!gamepad || gamepad.axes.length < 4) continue;
      const [x, y] = [beyond(gamepad.axes[2]), beyond(gamepad.axes[3])];
      if (handedness === 'right') this.#turn(x, head);
      const distance_m = kSpeed * focal_m * pause_s;
      const aim = this.placed(head).orientation;
      const moved = handedness === 'right' ? [0, -y * distance_m, 0] :
        rotate(aim, [x * distance_m, 0, y * distance_m]);
      this.#offset_m = add(this.#offset_m, moved);
    }
  }

  // The head stays where it is.
  #turn(x, head) {
    if (Math.abs(x) < kReleased) this.#mayTurn = true;
    if (!this.#mayTurn || Math.abs(x) < kSnap) return;
    this.#mayTurn = false;
    const before = this.placed(head).position;
    this.#orientation = multiply(turn(kUp, -Math.sign(x) * kSnap_rad), this.#orientation);
    this.#offset_m = add(this.#offset_m, subtract(before, this.placed(head).position));
  }
}
