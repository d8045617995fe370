// SPDX-License-Identifier: Apache-2.0
// The viewer page: joins the choices, the connection, the picture and the figures.
import {AtlasStream} from './atlas_stream.js';
import {AutoDetail} from './auto_detail.js';
import {Decoder} from './decoder.js';
import {DisplayControls} from './display_controls.js';
import {Look} from './look.js';
import {Panel} from './panel.js';
import {Stage} from './stage.js';

const kPoll_ms = 2000;
const kHiddenGrace_ms = 5000;
const kNoticeTime_ms = 6000;
const kDefaultPreset = 'portrait';

const byId = (id) => document.getElementById(id);
const root = document.documentElement;
const panel = new Panel();
const controls = new DisplayControls((parameters) => stream.change(parameters));
const autoDetail = new AutoDetail(() => stream.change(sizeParameters(pageParameters())));
let presets = [];
let watching = null;  // name of the stream
let publishing = true;  // whether the stream's publisher was there when last asked
let noticeTimer = 0;
let hiddenTimer = 0;

const stage = new Stage(byId('stage'), (atlas) => {
  if (!atlas.acknowledged) {
    atlas.acknowledged = true;
    stream.shown(atlas.header.delivery);
    panel.noteShown(atlas);
    if (byId('detail').value === 'auto') autoDetail.note(atlas.header, performance.now());
  }
  root.dataset.sequence = atlas.header.sequence;
});

const decoder = new Decoder(
    (atlas) => {
      setState('live');
      stage.show(atlas);
      controls.show(atlas.header.layout);
      nameView();
    },
    (atlas) => {
      stream.shown(atlas.header.delivery);
      panel.noteDropped();
    });

const stream = new AtlasStream({
  onAtlas(atlas) {
    panel.noteArrived();
    decoder.decode(atlas);
  },
  onLive() {
    autoDetail.restart();
    notice('');
  },
  onWaiting({message, retry_ms}) {
    setState('reconnecting');
    notice(`${message} Trying again in ${Math.ceil(retry_ms / 1000)} s.`, 'bad', Infinity);
  },
  onRefused(error) { notice(error.message, 'bad'); },
});

new Look(byId('stage'), byId('view'), (position) => {
  stage.look(position);
  nameView();
});

function nameView() {
  const count = stage.layout?.view_count ?? 0;
  const view = Math.round(stage.position * (count - 1)) + 1;
  byId('ruler-view').textContent = count ? `view ${view} of ${count}` : 'view –';
  byId('view').setAttribute('aria-valuetext', byId('ruler-view').textContent);
}

function setState(state) {
  root.dataset.state = state;
  byId('welcome').hidden = state !== 'no-stream';
}

function notice(text, kind = '', time_ms = kNoticeTime_ms) {
  const shown = byId('notice');
  clearTimeout(noticeTimer);
  shown.textContent = text;
  shown.dataset.kind = kind;
  shown.hidden = text === '';
  if (text && time_ms !== Infinity) noticeTimer = setTimeout(() => notice(''), time_ms);
}

// The page's own parameters are those of /ws. What it has no control for is passed on as it is.
function pageParameters() {
  return new URLSearchParams(location.search);
}

function chosenPreset() {
  return presets.find(({name}) => name === byId('preset').value);
}

// Width and height of the quilt: the address's or the preset's, times the detail.
function sizeParameters(parameters) {
  const chosen = byId('detail').value;
  const detail = chosen === 'auto' ? autoDetail.detail : Number(chosen);
  const size = {};
  for (const side of ['width', 'height']) {
    const full_px = Number(parameters.get(side) ?? chosenPreset()?.size[side]);
    if (full_px) size[side] = Math.round(full_px * detail);
  }
  return size;
}

function watchParameters() {
  const parameters = pageParameters();
  const size = sizeParameters(parameters);
  parameters.delete('detail');
  parameters.set('stream', watching);
  if (chosenPreset()) parameters.set('preset', chosenPreset().name);
  for (const [side, length_px] of Object.entries(size)) parameters.set(side, length_px);
  return parameters;
}

function watch(name) {
  watching = name;
  publishing = true;
  panel.clear();
  controls.forget();
  setState('connecting');
  stream.open(watchParameters());
}

// A choice made by hand is kept in the address, so that a reload and a link show the same.
function choose(changes) {
  const parameters = pageParameters();
  for (const [name, value] of Object.entries(changes)) {
    if (value === null) parameters.delete(name);
    else parameters.set(name, value);
  }
  history.replaceState(null, '', `?${parameters}`);
  if (watching) watch(watching);
}

async function fetchStreams() {
  const reply = await fetch('/api/streams', {cache: 'no-store'});
  return (await reply.json()).streams;
}

function showStreams(streams) {
  const select = byId('stream');
  const label = ({name, live}) => live ? name : `${name} (still)`;
  const wanted = streams.map(label).join('\n');
  if (select.dataset.shown !== wanted) {
    select.dataset.shown = wanted;
    select.replaceChildren(...streams.map((entry) => new Option(label(entry), entry.name)));
  }
  select.disabled = streams.length === 0;
  if (watching) select.value = watching;
}

function notePublisher(entry) {
  if (!entry || entry.live === publishing) return;
  publishing = entry.live;
  notice(publishing ? '' : 'The publisher left. This is its last frame.', '', Infinity);
}

// Looks for streams; watches the one asked for, else the first that is live, else the first.
async function poll() {
  try {
    const streams = await fetchStreams();
    const asked = pageParameters().get('stream');
    const found = streams.find(({name}) => name === asked) ??
        streams.find(({live}) => live) ?? streams[0];
    if (!watching && found) watch(found.name);
    showStreams(streams);
    notePublisher(streams.find(({name}) => name === watching));
    if (!watching && !found) {
      setState('no-stream');
      notice('');
    }
  } catch {
    if (!watching) notice('The server does not answer. Trying again.', 'bad', Infinity);
  }
  setTimeout(poll, kPoll_ms);
}

async function start() {
  const parameters = pageParameters();
  try {
    presets = (await (await fetch('/api/presets')).json()).presets;
  } catch {
    setTimeout(start, kPoll_ms);
    notice('The server does not answer. Trying again.', 'bad', Infinity);
    return;
  }
  const options = presets.map(({name, device}) => new Option(device, name));
  if (parameters.has('columns')) options.unshift(new Option('as in the address', ''));
  byId('preset').replaceChildren(...options);
  const standard = parameters.has('columns') ? '' : kDefaultPreset;
  byId('preset').value = parameters.get('preset') ?? standard;
  byId('detail').value = parameters.get('detail') ?? (parameters.has('width') ? '1' : 'auto');
  if (byId('detail').selectedIndex < 0) byId('detail').value = 'auto';  // none of the choices
  poll();
}

function toggle(id, key, apply) {
  const button = byId(id);
  const flip = () => {
    const on = button.getAttribute('aria-pressed') !== 'true';
    button.setAttribute('aria-pressed', on);
    apply(on);
  };
  button.addEventListener('click', flip);
  keys[key] = flip;
}

const keys = {f: () => byId('fullscreen').click()};
toggle('quilt', 'q', (on) => { stage.whole = on; stage.invalidate(); });
toggle('blend', 'b', (on) => { stage.blend = on; stage.invalidate(); });
toggle('details', 'i', (on) => { byId('panel').hidden = !on; });
byId('fullscreen').addEventListener('click', () => {
  if (document.fullscreenElement) document.exitFullscreen();
  else document.querySelector('main').requestFullscreen();
});
document.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey || event.target.matches('select')) return;
  keys[event.key.toLowerCase()]?.();
});

byId('stream').addEventListener('change', ({target}) => {
  watching = target.value;
  choose({stream: target.value});
});
byId('preset').addEventListener('change', ({target}) => {
  choose({preset: target.value || null, columns: null, rows: null, width: null, height: null,
          aspect: null, cone_deg: null, focus_m: null});
});
byId('detail').addEventListener('change', ({target}) => {
  choose({detail: target.value});
});

// Nobody looks: the display need not be traced.
document.addEventListener('visibilitychange', () => {
  clearTimeout(hiddenTimer);
  autoDetail.restart();
  if (document.hidden) {
    hiddenTimer = setTimeout(() => {
      stream.close();
      setState('hidden');
    }, kHiddenGrace_ms);
  } else if (root.dataset.state === 'hidden' && watching) {
    watch(watching);
  }
});

start();
