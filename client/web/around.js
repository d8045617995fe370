// SPDX-License-Identifier: Apache-2.0
// Looking around: the page asks for the one view that the eye sees, as large as its canvas, by
// poses; and shows the newest picture from where the eye is by then.
import {EyePoses} from './eye_poses.js';
import {EyeRig} from './eye_rig.js';
import {EyeSize} from './eye_size.js';
import {LatePicture} from './late_picture.js';
import {RigControls} from './rig_controls.js';
import {cameraOf} from './view_camera.js';

const kSideMax_px = 4096;
const kGround = '#0a0c10';
// The eye before anybody knows what it would see: the server frames the display itself.
const kPlainEye = {pose: {}};
const kSame = 1e-6;  // of two cameras, m and tangents

// Whether two cameras see the same.
function isSame(a, b) {
  const flat = ({position, orientation, focal_px, principal_px}) =>
    [...position, ...orientation, ...principal_px.map((side, axis) => side / focal_px[axis])];
  const [left, right] = [flat(a), flat(b)];
  return left.every((value, index) => Math.abs(value - right[index]) < kSame);
}

export class Around {
  #stage;
  #poses;
  #isRunning = false;
  #isLed = false;     // the next frame comes by look()
  #onward_ms = null;  // when the step before this one was, if it led to this one
  #display = '';     // that is asked for, but for its size
  #fixed = null;     // the share of the canvas that the visitor chose; null = automatic
  #shows = null;     // {atlas, camera, view}: the newest of the eye's own pictures
  active = false;

  // stage: whose canvas is looked at; send(message): whether it went; onSize(): the picture shall
  // have another size, or come without depth
  constructor(stage, send, onSize) {
    this.#stage = stage;
    this.#poses = new EyePoses(send);
    this.rig = new EyeRig();
    this.size = new EyeSize(onSize);
    this.late = new LatePicture(undefined, onSize);
    this.controls = new RigControls(stage.canvas, this.rig, () => this.run());
  }

  // Views of the display whose cone the eye moves in, and how they share it.
  set cone(cone) { this.rig.cone = cone; }
  get total() { return this.rig.cone.count; }
  get view() { return Math.round(this.rig.position * (this.total - 1)); }
  get latency() { return this.#poses.latency; }
  get fullWidth_px() { return this.#fullWidth_px; }
  #fullWidth_px = 0;

  // The message Display of the eye. quilt: what else is watched; others: fields that stay; room:
  // px of the canvas for the picture; fixed: a share of them, or null.
  asked(quilt, others, room, fixed) {
    const {width, height} = room;
    this.#fullWidth_px = width;
    this.#fixed = fixed;
    this.size.fit({width, height});
    const display = {
      ...others,
      stereo: {layout: 'STEREO_LAYOUT_SINGLE', tracked: true, ...Object.fromEntries(
          ['focal_distance_m', 'fov_y_rad'].filter((name) => quilt[name] !== undefined)
              .map((name) => [name, quilt[name]]))},
    };
    const text = JSON.stringify([display, (width / height).toFixed(2)]);
    if (text !== this.#display) {
      this.#display = text;
      this.rig.forgetWindow();
      this.late.clear();
      this.run();
    }
    return {...display, stereo: {...display.stereo, eye_size: this.#eyeSize(room)}};
  }

  #eyeSize(room) {
    const even = (px) => Math.max(2, 2 * Math.round(px / 2));
    const size = this.#fixed === null ? this.size.size :
      {width: even(room.width * this.#fixed), height: even(room.height * this.#fixed)};
    const shrink = Math.min(1, kSideMax_px / Math.max(size.width, size.height));
    return {width: even(size.width * shrink), height: even(size.height * shrink)};
  }

  // Another connection: the server knows nothing of this eye.
  restart() {
    this.#poses.restart();
    this.rig.forgetWindow();
    this.late.clear();
    this.#shows = null;
    this.size.restart();
    this.run();
  }

  // position: in the cone, 0..1; isLed: the next frame brings another. The pose goes within this
  // frame.
  look(position, isLed = false) {
    this.rig.position = position;
    this.#isLed = isLed;
    this.#step(performance.now());
  }

  takeClock(reply) { this.#poses.takeClock(reply); }

  // An atlas came, and is about to be shown. isNewest: of the display that was asked for last.
  take(atlas, isNewest) {
    const {layout} = atlas.header;
    const note = this.#poses.noteOf(atlas.header);
    const isOwn = layout.views?.length === 1 && layout.view_cone_rad === 0;
    if (!isOwn) return;
    const isPlain = isNewest && (!atlas.header.eyes || note?.isPlain);
    if (!this.rig.isKnown && isPlain) this.rig.takeWindow(layout);
    const camera = cameraOf(layout.views[0]);
    this.#shows = {atlas, camera, view: note?.view ?? Math.floor(this.total / 2)};
    this.late.take(atlas, [camera]);
    this.run();
  }

  // It is on the screen for the first time.
  noteShown(atlas) {
    if (atlas !== this.#shows?.atlas) return;
    this.#poses.shown(atlas.header);
    this.size.noteShown(atlas.header, performance.now(), this.#poses.line_ms);
  }

  // Time passes: to be called several times a second.
  tick(now_ms) {
    if (!this.active) return;
    this.#poses.probe(now_ms);
    if (this.#fixed === null) this.size.look(now_ms);
  }

  // Follows the eye at the screen's rate, until the server has shown where it stands.
  run() {
    if (this.#isLed || this.#isRunning || !this.active) return;
    this.#isRunning = true;
    requestAnimationFrame((now_ms) => {
      this.#isRunning = false;
      if (!this.#isLed) this.#step(now_ms);
    });
  }

  #step(now_ms) {
    const before_ms = this.#onward_ms;
    this.#onward_ms = null;
    if (!this.active) return;
    // The first picture of a connection shows that by itself.
    if (!this.rig.isKnown && this.#poses.isFresh) return;
    const eye = this.rig.isKnown ? this.rig.message : kPlainEye;
    const note = {view: this.rig.isKnown ? this.view : Math.floor(this.total / 2),
      isPlain: !this.rig.isKnown};
    if (this.#poses.put([eye], note) && this.rig.isKnown) {
      this.size.noteMoved(performance.now(), this.rig.isMoved ? 'free' : 'sideways');
    }
    if (!this.late.isOn) return;
    if (before_ms !== null) this.late.notePace(now_ms - before_ms);
    this.#stage.drawNow();
    if (!this.#shows || this.#poses.isNewest(this.#shows.atlas.header)) return;
    this.#onward_ms = now_ms;
    this.run();
  }

  // Draws to the stage's canvas.
  draw(atlas) {
    const {canvas, context} = this.#stage;
    if (atlas !== this.#shows?.atlas) return;  // one of the display before
    const frame = this.#stage.frame(atlas.header.layout.aspect);
    const [left, top, width, height] = frame;
    context.fillStyle = kGround;
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.imageSmoothingQuality = 'high';
    context.drawImage(this.#lateCanvas(width, height) ?? atlas.bitmap, left, top, width, height);
    canvas.dataset.view = this.#shows.view;
  }

  // Where the picture shows what the eye sees by now, it is shown as it is.
  #lateCanvas(width, height) {
    if (!this.late.isOn || !this.rig.isKnown) return null;
    const {atlas, camera} = this.#shows;
    if (isSame(camera, this.rig.camera(atlas.header.layout.tile_size))) return null;
    return this.late.draw(this.rig.camera({width, height}), {width, height});
  }
}
