// SPDX-License-Identifier: Apache-2.0
// The viewer page: joins the choices, the modes, the connection, the picture and the figures.
import {keepInAddress, pageParameters} from './address.js';
import {Around} from './around.js';
import {AtlasStream} from './atlas_stream.js';
import {watchAttention} from './attention.js';
import {AutoDetail} from './auto_detail.js';
import {Commands} from './commands.js';
import {Decoder} from './decoder.js';
import {DepthBudget} from './depth_budget.js';
import {watchDeviceSize} from './device_size.js';
import {DisplayChoice} from './display_choice.js';
import {DisplayControls} from './display_controls.js';
import {DisplayDocument} from './display_document.js';
import {DisplayLists} from './display_lists.js';
import {EyeMode} from './eye_mode.js';
import {Figures} from './figures.js';
import {offerFullScreen} from './full_screen.js';
import {Look} from './look.js';
import {offerModeKeys} from './mode_keys.js';
import {Modes} from './modes.js';
import {endWaiting, notice, noticeWaiting} from './notice.js';
import {nameView, setState, shapePicture} from './page_state.js';
import {PanelMode} from './panel_mode.js';
import {Patience} from './patience.js';
import {labelReduced} from './reduced_label.js';
import {RgbdMode} from './rgbd_mode.js';
import {toggle} from './shortcuts.js';
import {SingleMode} from './single_mode.js';
import {Stage} from './stage.js';
import {StreamList} from './stream_list.js';
import {Tilt} from './tilt.js';
import {badAddress, endTrouble, missingStream, showTrouble} from './trouble.js';
import {findVideo, giveUpVideo} from './video_choice.js';
import {ViewsOutside} from './views_outside.js';
import {Weaver} from './weaver.js';
import {XrButton} from './xr_button.js';

const kRetry_ms = 1000;
const kLook_ms = 100;     // from one look for a picture that stands still to the next
const kResized_ms = 150;  // a size that stays as long is asked for
const kPainted = ['panel', 'eye', 'rgbd'];  // modes that draw by themselves
const kSilence = 'The server does not answer. Trying again.';

const byId = (id) => document.getElementById(id);
const root = document.documentElement;
let watching = null;  // name of the stream
let chosen = null;    // the DisplayDocument
let resizeTimer = 0;
let isPublisherGone = false;
const onVideoFailed = (reason) => giveUpVideo(reason, ask);
const figures = new Figures();
const commands = new Commands();
const patience = new Patience();
const controls = new DisplayControls(ask);
const lists = new DisplayLists((changes) => {
  if (changes['effects.lens']) autoDetail.startLow();
  ask();
});
const budget = new DepthBudget((fields) => controls.take(fields));
const outside = new ViewsOutside();
const autoDetail = new AutoDetail(ask);
const stage = new Stage(byId('stage'), {
  onDrawn(atlas) {
    if (!atlas.acknowledged) {
      atlas.acknowledged = true;
      stream.shown(atlas.header.delivery);
      figures.noteShown(atlas);
      around.noteShown(atlas);
      figures.noteMotion(display.isEye ? around.latency : null);
      if (isDetailAutomatic()) autoDetail.note(atlas.header, performance.now());
    }
    root.dataset.sequence = atlas.header.sequence;
  },
  onResize() {
    clearTimeout(resizeTimer);
    resizeTimer = setTimeout(ask, kResized_ms);
  },
});

const around = new Around(stage, (message) => stream.send(message), ask);
const display = new DisplayChoice(autoDetail, around, (aspect) => stage.frame(aspect), () => {
  offerModes();
  if (watching) watch(watching);
});

// The eye's own picture has a detail of its own (eye_size.js).
const isDetailAutomatic = () => display.isAutomatic && !display.isEye;
const viewCount = () => stage.layout && display.isEye ? around.total : stage.total;

// Asks for what shall be seen, if that is not what the server sends.
function ask() {
  if (watching) stream.change(display.asked(watching));
}

// Has the eye look from where it stands in the mode that is on. isOnItsWay: as look.js says it
function aim(isOnItsWay = false) {
  if (!display.isEye) return;
  if (modes.mode === 'single') around.look(single.view / Math.max(1, around.total - 1));
  else around.look(stage.position, isOnItsWay);
}

const decoder = new Decoder(
    (atlas) => {
      const {layout} = atlas.header;
      if (display.isEye) around.take(atlas, stream.isNewest(atlas));
      stage.show(atlas);
      if (stream.isOpen) setState('live', watching, viewCount());
      single.layoutChanged(viewCount());
      const whole = display.isEye ? {...layout, view_cone_rad: display.cone_rad} : layout;
      controls.show(whole);
      lists.show(whole);
      budget.show(atlas.header.depth_budget, layout);
      outside.show(atlas.header.views_outside, layout);
      commands.show(display.elsewhere(watching));
      labelReduced(layout.tile_size.width, display.fullWidth_px, display.isAutomatic);
      nameView(stage.position, viewCount());
      shapePicture(layout, modes.mode);
    },
    (atlas) => {
      stream.shown(atlas.header.delivery);
      figures.noteDropped();
    }, onVideoFailed);

const stream = new AtlasStream({
  onAtlas(atlas) {
    patience.end();
    figures.noteArrived();
    decoder.decode(atlas);
  },
  onLive() {
    autoDetail.restart();
    around.restart();
    endWaiting();
  },
  onClock(reply) { around.takeClock(reply); },
  onAsked() { patience.begin(); },
  onWaiting(reason) {
    patience.end();
    setState('reconnecting');
    noticeWaiting(reason);
  },
  onRefused(error) { notice(error.message, 'bad'); },
  onGivenUp({message}) {
    patience.end();
    refuse({title: 'The server does not show this', text: message, again: () => watch(watching)});
  },
});

const look = new Look(byId('stage'), byId('view'), (position, isOnItsWay) => {
  stage.look(position);
  aim(isOnItsWay);
  nameView(stage.position, viewCount());
});
new Tilt(byId('tilt'), (position) => look.take(position));
new XrButton(byId('vr'), {
  asked: (...eyes) => display.inHeadset(watching, ...eyes),
  onEnter: rest,
  onShown(latency, ...widths_px) {
    figures.noteMotion(latency);
    labelReduced(...widths_px, true);
  },
  onLeave: () => watching && watch(watching),
});
const single = new SingleMode(stage, () => aim());
const weaver = new Weaver(byId('woven'));
const panelMode = new PanelMode(weaver, () => stage.invalidate());
const eyeMode = new EyeMode(weaver, () => panelMode.calibration, () => stage.invalidate());
watchDeviceSize(byId('woven'), (size_px) => {
  panelMode.resize(size_px);
  eyeMode.resize(size_px);
  stage.invalidate();
});

// Draws by WebGL as long as the mode lasts.
async function paint(mode) {
  stage.painter = mode;
  await mode.enter().catch((error) => notice(error.message, 'bad', Infinity));
  stage.invalidate();
}

const modes = new Modes({
  look: {enter: () => { look.active = true; }, leave: () => { look.active = false; }},
  single,
  quilt: {enter: () => { stage.whole = true; }, leave: () => { stage.whole = false; }},
  panel: {enter: () => paint(panelMode), leave: () => panelMode.leave()},
  eye: {enter: () => paint(eyeMode)},
  rgbd: new RgbdMode(stage),
}, (mode) => {
  if (!kPainted.includes(mode)) stage.painter = null;
  seeAsOf(mode);
  shapePicture(stage.layout, mode);
  stage.invalidate();
  keepInAddress({mode: mode === 'look' ? null : mode});
});

function seeAsOf(mode) {
  display.seen = {look: 'eye', single: 'eye', rgbd: 'middle'}[mode] ?? 'all';
  around.active = display.isEye;
  around.controls.active = display.isEye && mode === 'look';
  if (display.isEye) stage.painter = around;
  display.asked(watching);  // how many views there are
  single.layoutChanged(viewCount());
  aim();
  ask();
}

function offerModes() {
  controls.showChosen(chosen);
  lists.showChosen(chosen);
  modes.restrict(display.modes, display.modesReason);
}

// Nothing can be shown: what showTrouble() takes.
function refuse(trouble) {
  setState('refused');
  notice('');
  showTrouble(trouble);
}

function watch(name) {
  watching = name;
  notice('');
  endTrouble();
  isPublisherGone = false;
  patience.end();
  streams.restart();
  figures.clear();
  controls.forget();
  chosen.forgetPassing();
  setState('connecting', watching);
  stream.open(display.asked(name));
}

const streams = new StreamList({
  asked: () => pageParameters().get('stream'),
  watching: () => watching,
  onFound: watch,
  onNone() {
    setState('no-stream');
    notice('');
  },
  onMissing(name, others, isLooking) {
    refuse(missingStream(name, others, isLooking ? null : () => streams.lookAgain()));
  },
  onPublisher(isThere) {
    isPublisherGone = figures.isOver = !isThere;
    notice(isThere ? '' : 'The publisher left. This is its last frame.', '', Infinity);
  },
  onSilence() { if (!watching) notice(kSilence, 'bad', Infinity); },
});

async function start() {
  try {
    await findVideo();
    chosen = await DisplayDocument.ofAddress((problem) => refuse(badAddress(problem)));
    if (!chosen) return;
  } catch {
    setTimeout(start, kRetry_ms);
    notice(kSilence, 'bad', Infinity);
    return;
  }
  display.show(chosen);
  offerModes();
  modes.choose(pageParameters().get('mode'));
  streams.poll();
}

offerFullScreen();
offerModeKeys(modes);
toggle(byId('details'), 'c', (isOn) => { byId('panel').hidden = !isOn; }, 'controls');

byId('stream').addEventListener('change', ({target}) => {
  keepInAddress({stream: target.value});
  watch(target.value);
});

setInterval(() => {
  if (root.dataset.state !== 'live' || document.hidden) return;
  around.tick(performance.now());
  if (isDetailAutomatic()) autoDetail.look(performance.now(), isPublisherGone);
}, kLook_ms);

// The display need not be traced.
function rest() {
  if (!watching) return;
  stream.close();
  patience.end();
  setState('hidden');
}

watchAttention({
  onTurn() { autoDetail.restart(); },
  onRest: rest,
  onLook() { if (root.dataset.state === 'hidden' && watching) watch(watching); },
});

start();
