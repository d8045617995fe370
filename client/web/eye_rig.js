// SPDX-License-Identifier: Apache-2.0
// Where the eye stands, and what it sees: its place in the display's cone, carried along by a rig
// that turns about the middle of the focal plane, and goes anywhere.
import {add, cameraMessage, cameraOf, cameraWithFov, fovOf, multiply, rotate, turn}
  from './view_camera.js';

const kUp = [0, 1, 0];
const kRight = [1, 0, 0];
// Cone of a quilt that says none.
export const kUsualCone_rad = 40 * Math.PI / 180;
const kElevationMax_rad = 80 * Math.PI / 180;
// The eye stays in front of the focal plane by this share of its distance.
const kNearest = 0.1;

// x of a view of a quilt, in units of the focal distance. position: 0 = the first view of `count`,
// 1 = the last. See CameraConvention of display.proto.
export function placeInCone(position, {count, cone_rad, depthiness = 1, convention}) {
  const number = position * (count - 1);
  const cone = cone_rad || kUsualCone_rad;
  const isWithEnds = count > 1 &&
      (convention === 'CAMERA_CONVENTION_CORE' || convention === 'CAMERA_CONVENTION_BRIDGE');
  const t = isWithEnds ? position - 0.5 : (number + 0.5) / count - 0.5;
  if (convention === 'CAMERA_CONVENTION_BRIDGE') return depthiness * Math.tan(cone) * t;
  return Math.tan(depthiness * cone * t);
}

export class EyeRig {
  #window = null;  // {left, right, up, down} in m on the focal plane, focal_m
  #azimuth_rad = 0;
  #elevation_rad = 0;
  #offset_m = [0, 0, 0];  // of the pivot, in the display's coordinates
  #back = 0;  // steps back from the pivot, a share of the focal distance

  position = 0.5;  // 0 = left end of the cone, 1 = right end
  cone = {count: 1, cone_rad: 0};

  // Until a layout came, nobody knows what the eye sees.
  get isKnown() { return this.#window !== null; }
  get focal_m() { return this.#window?.focal_m ?? 0; }
  get isMoved() {
    return this.#azimuth_rad !== 0 || this.#elevation_rad !== 0 || this.#back !== 0 ||
        this.#offset_m.some((value) => value !== 0);
  }

  // Takes the rectangle that the display frames from a layout whose view looks straight ahead.
  takeWindow({views, tile_size, focal_distance_m}) {
    const camera = cameraOf(views[0]);
    const fov = fovOf(camera, tile_size);
    const [x, y, z] = camera.position;
    const away_m = focal_distance_m + z;
    this.#window = {
      left: x + fov.left * away_m, right: x + fov.right * away_m,
      up: y + fov.up * away_m, down: y + fov.down * away_m, focal_m: focal_distance_m,
    };
  }

  // Another stream or display frames something else.
  forgetWindow() { this.#window = null; }

  // Turns about the middle of the focal plane.
  orbit(right_rad, up_rad) {
    this.#azimuth_rad += right_rad;
    const elevation_rad = this.#elevation_rad + up_rad;
    this.#elevation_rad = Math.max(-kElevationMax_rad, Math.min(kElevationMax_rad, elevation_rad));
  }

  // Moves eye and pivot along the picture, in shares of the focal distance.
  pan(right, up) {
    const moved_m = [right * this.focal_m, up * this.focal_m, 0];
    this.#offset_m = add(this.#offset_m, rotate(this.#turned, moved_m));
  }

  // Towards the pivot, as a share of the focal distance.
  step(forward) {
    this.#back = Math.max(kNearest - 1, this.#back - forward);
  }

  reset() {
    [this.#azimuth_rad, this.#elevation_rad, this.#back] = [0, 0, 0];
    this.#offset_m = [0, 0, 0];
  }

  get #turned() {
    return multiply(turn(kUp, this.#azimuth_rad), turn(kRight, -this.#elevation_rad));
  }

  // {pose: {position, orientation}, fov}: see cameraWithFov. isKnown has to hold.
  get eye() {
    const {focal_m, left, right, up, down} = this.#window;
    const x = focal_m * placeInCone(this.position, this.cone);
    const z = focal_m * this.#back;
    const orientation = this.#turned;
    const pivot = add(this.#offset_m, [0, 0, -focal_m]);
    // A step changes where the eye stands and not how wide it sees: the window comes along.
    const fov = {left: (left - x) / focal_m, right: (right - x) / focal_m, up: up / focal_m,
      down: down / focal_m};
    return {
      pose: {position: add(pivot, rotate(orientation, [x, 0, focal_m + z])), orientation},
      fov,
    };
  }

  get message() {
    const {pose, fov} = this.eye;
    return cameraMessage(pose, fov);
  }

  camera(size_px) {
    const {pose, fov} = this.eye;
    return cameraWithFov(pose, fov, size_px);
  }
}
