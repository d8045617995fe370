// SPDX-License-Identifier: Apache-2.0
// One stay in a headset: sends the poses of its eyes, and shows their newest pictures from where
// they are by then, at the headset's rate.
import {AtlasStream} from './atlas_stream.js';
import {Decoder} from './decoder.js';
import {EyePoses} from './eye_poses.js';
import {EyeSize} from './eye_size.js';
import {Reprojector} from './reprojector.js';
import {cameraMessage, cameraOf, cameraWithFov} from './view_camera.js';
import {XrWalk} from './xr_walk.js';

const kLook_ms = 100;
const kUsualFocal_m = 1;  // until a picture says how far things are

// Tangents of the angles that a projection matrix sees.
export function fovOfProjection(matrix) {
  const [width, height] = [matrix[0], matrix[5]];
  return {
    left: (matrix[8] - 1) / width, right: (matrix[8] + 1) / width,
    up: (matrix[9] + 1) / height, down: (matrix[9] - 1) / height,
  };
}

const poseOf = ({position: p, orientation: q}) =>
  ({position: [p.x, p.y, p.z], orientation: [q.x, q.y, q.z, q.w]});

export class XrStay {
  #session;
  #space;
  #layer;
  #gl;
  #asked;
  #onShown;
  #reprojector;
  #stream;
  #decoder;
  #poses;
  #size;
  #walk = new XrWalk();
  #focal_m = kUsualFocal_m;
  #count = 0;  // of eyes
  #timer;
  #problem = '';  // that ended it
  #isOver = false;

  // asked(eye_size, count): what /ws is asked for; onShown(latency of EyePoses, width and full
  // width of an eye's picture in px); onProblem(sentence); onEnd(sentence): why, '' = it was left
  static async begin(xr, handlers) {
    const session = await xr.requestSession('immersive-vr');
    try {
      const canvas = document.createElement('canvas');
      const gl = canvas.getContext('webgl2', {xrCompatible: true, antialias: false, depth: true});
      if (!gl) throw new Error('This browser has no WebGL2, which VR needs.');
      await gl.makeXRCompatible?.();
      const layer = new XRWebGLLayer(session, gl, {antialias: false});
      await session.updateRenderState({baseLayer: layer});
      const space = await session.requestReferenceSpace('local');
      return new XrStay({session, space, layer, gl, ...handlers});
    } catch (error) {
      await session.end();
      throw error;
    }
  }

  constructor({session, space, layer, gl, asked, onShown, onProblem, onEnd}) {
    [this.#session, this.#space, this.#layer, this.#gl] = [session, space, layer, gl];
    [this.#asked, this.#onShown] = [asked, onShown];
    this.#reprojector = new Reprojector(gl);
    this.#stream = new AtlasStream({
      onAtlas: (atlas) => this.#decoder.decode(atlas),
      onLive: () => this.#poses.restart(),
      onAsked() {},
      onClock: (reply) => this.#poses.takeClock(reply),
      onWaiting: (reason) => onProblem(reason),
      onRefused: ({message}) => onProblem(message),
      onGivenUp: ({message}) => this.#giveUp(message),
    });
    this.#decoder = new Decoder((atlas) => this.#take(atlas),
        (atlas) => this.#stream.shown(atlas.header.delivery));
    this.#poses = new EyePoses((message) => this.#stream.send(message));
    this.#size = new EyeSize(() => this.#stream.change(this.#request()));
    this.#timer = setInterval(() => this.#tick(), kLook_ms);
    session.addEventListener('end', () => {
      this.#end();
      onEnd(this.#problem);
    });
    session.requestAnimationFrame((time_ms, frame) => this.#draw(time_ms, frame));
  }

  leave() { return this.#session.end(); }

  // Nothing will ever be shown.
  #giveUp(problem) {
    this.#problem = problem;
    this.leave().catch(() => {});  // it may end already
  }

  #request() { return this.#asked(this.#size.size, this.#count); }

  #tick() {
    const now_ms = performance.now();
    this.#poses.probe(now_ms);
    this.#size.look(now_ms);
  }

  #take(atlas) {
    const {layout} = atlas.header;
    this.#stream.shown(atlas.header.delivery);
    if (!this.#isOver && layout.views?.length === this.#count && atlas.depth.columns) {
      this.#focal_m = layout.focal_distance_m || kUsualFocal_m;
      this.#reprojector.take(atlas, layout.views.map(cameraOf));
      this.#poses.shown(atlas.header);
      this.#size.noteShown(atlas.header, performance.now());
      this.#onShown(this.#poses.latency, layout.tile_size.width, this.#size.fullWidth_px);
    }
    atlas.release();
  }

  #draw(time_ms, frame) {
    if (this.#isOver) return;
    this.#session.requestAnimationFrame((next_ms, next) => this.#draw(next_ms, next));
    const viewer = frame.getViewerPose(this.#space);
    if (!viewer) return;
    const head = poseOf(viewer.transform);
    this.#walk.step(this.#session.inputSources, head, this.#focal_m, time_ms / 1000);
    const eyes = viewer.views.map((view) => ({
      viewport: this.#layer.getViewport(view),
      pose: this.#walk.placed(poseOf(view.transform)),
      fov: fovOfProjection(view.projectionMatrix),
      isRight: view.eye === 'right',
    })).filter(({viewport}) => viewport.width > 0 && viewport.height > 0);
    eyes.sort((a, b) => a.isRight - b.isRight);
    this.#ask(eyes);
    this.#gl.bindFramebuffer(this.#gl.FRAMEBUFFER, this.#layer.framebuffer);
    eyes.forEach(({viewport, pose, fov}, index) =>
      this.#reprojector.draw(cameraWithFov(pose, fov, viewport), viewport, index));
  }

  #ask(eyes) {
    if (eyes.length === 0) return;
    if (this.#count !== eyes.length) {
      this.#count = eyes.length;
      this.#size.fit(eyes[0].viewport);
      this.#reprojector.clear();
      this.#stream.open(this.#request());
    }
    const messages = eyes.map(({pose, fov}) => cameraMessage(pose, fov));
    if (this.#poses.put(messages, {})) this.#size.noteMoved(performance.now(), 'free');
  }

  #end() {
    this.#isOver = true;
    clearInterval(this.#timer);
    this.#stream.close();
    this.#decoder.close();
    this.#reprojector.clear();
    this.#gl.getExtension('WEBGL_lose_context')?.loseContext();
  }
}
