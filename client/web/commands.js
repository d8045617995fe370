// SPDX-License-Identifier: Apache-2.0
// What is watched here, as commands and addresses to watch it elsewhere.

const kGrpcPort = 50051;  // viewloomd's own; the page cannot know another
const kLoopback = ['localhost', '127.0.0.1', '[::1]'];
// Parameters of /ws, and the options of `viewloom watch` that mean the same.
const kEncodingOptions = {quality: '--quality'};
const kOptions = {
  ...kEncodingOptions, preset: '--preset', columns: '--columns', rows: '--rows', cone_deg: '--cone',
  focus_m: '--focal-distance', focus_follow_s: '--focus-follow', fov_deg: '--fov',
  lens_focus_m: '--lens-focus', effort: '--effort', rate_hz: '--output-rate', between: '--between',
  reflections: '--reflections',
};
const kRgbdOptions = {
  ...kEncodingOptions, preset: '--preset', rgbd: '--rgbd-form', near_m: '--depth-near',
  far_m: '--depth-far', screen_m: '--screen', depth_side: '--depth-side', fov_deg: '--fov',
};
const kRadPerDeg = Math.PI / 180;

const byId = (id) => document.getElementById(id);

// For a POSIX shell.
function quoted(text) {
  return /^[\w.:/=+,-]+$/.test(text) ? text : `'${text.replaceAll('\'', '\'\\\'\'')}'`;
}

// The quilt as a Display message in JSON: for what no option says.
function displayFile(parameters) {
  const number = (name) => parameters.has(name) ? Number(parameters.get(name)) : undefined;
  const angle = (name) => parameters.has(name) ? number(name) * kRadPerDeg : undefined;
  const aperture_m = parameters.get('aperture_m');
  const lens = aperture_m === null ? undefined : {
    ...(aperture_m === 'auto' ? {automaticAperture: true} : {apertureRadiusM: Number(aperture_m)}),
    focusDistanceM: number('lens_focus_m'),
  };
  const mode = {predict: 'TEMPORAL_MODE_PREDICT', interpolate: 'TEMPORAL_MODE_INTERPOLATE'};
  const temporal = parameters.has('rate_hz') ?
    {outputRateHz: number('rate_hz'), mode: mode[parameters.get('between')]} : undefined;
  const reflection = parameters.has('reflections') ? {bounces: number('reflections')} : undefined;
  const quality = parameters.has('effort') ?
    `QUALITY_${parameters.get('effort').toUpperCase()}` : undefined;
  const effects = lens || temporal || reflection ? {lens, temporal, reflection} : undefined;
  return JSON.stringify({focusFollowingS: number('focus_follow_s'), effects, quality, quilt: {
    columns: number('columns'), rows: number('rows'),
    size: {width: number('width'), height: number('height')}, aspect: number('aspect'),
    viewConeRad: angle('cone_deg'), focalDistanceM: number('focus_m'), fovYRad: angle('fov_deg'),
  }});
}

// parameters: URLSearchParams of /ws; kind: 'quilt', 'integral' or 'rgbd'
function watchCommand(parameters, kind) {
  const isRgbd = kind === 'rgbd';
  const words = ['viewloom'];
  if (!kLoopback.includes(location.hostname)) {
    words.push('--server', `${location.hostname}:${kGrpcPort}`);
  }
  words.push('watch', parameters.get('stream'));
  // An aspect beside that of a tile is told by a file alone.
  const isFile = parameters.has('aspect') && !parameters.has('preset');
  if (isFile) words.push('--display', 'display.json');
  const options = isRgbd ? kRgbdOptions : isFile ? kEncodingOptions : kOptions;
  for (const [name, option] of Object.entries(options)) {
    if (parameters.has(name)) words.push(option, parameters.get(name));
  }
  if (!isFile && parameters.has('width') && parameters.has('height')) {
    words.push(isRgbd ? '--rgbd' : '--size',
        `${parameters.get('width')}x${parameters.get('height')}`);
  }
  if (parameters.get('black_near') === '1') words.push('--black-near');
  const aperture_m = parameters.get('aperture_m');
  if (!isFile && aperture_m === 'auto') words.push('--auto-aperture');
  else if (!isFile && aperture_m !== null) words.push('--aperture', aperture_m);
  if (parameters.get('chroma') === '444') words.push('--444');
  const watch = [...words, '--out', 'atlases'].map(quoted).join(' ');
  if (!isFile) return watch;
  return `echo ${quoted(displayFile(parameters))} > display.json && ${watch}`;
}

// The server tells curl the file's name.
function stillCommand(parameters) {
  const query = new URLSearchParams(parameters);
  const take = (name) => {
    const value = query.get(name);
    query.delete(name);
    return value;
  };
  const stream = encodeURIComponent(take('stream'));
  take('depth');  // stills have none
  const isNamed = query.has('preset') && !query.has('columns');
  const path = isNamed ? `${stream}/${encodeURIComponent(take('preset'))}` :
    `${stream}${suffix(query)}.jpg`;
  const url = new URL(`/still/${path}`, location.href);
  url.search = query;
  return `curl -L -O -J ${quoted(url.href)}`;
}

// "_qs8x6a0.75" of a quilt of one's own; the server redirects where it knows better.
function suffix(query) {
  const value = (name) => Number(query.get(name));
  const tile = (side, count) => Math.floor(value(side) / value(count));
  const aspect = value('aspect') || tile('width', 'columns') / tile('height', 'rows');
  return `_qs${value('columns')}x${value('rows')}a${Number(aspect.toPrecision(6))}`;
}

function socketAddress(parameters) {
  const url = new URL(`/ws?${parameters}`, location.href);
  url.protocol = url.protocol.replace('http', 'ws');
  return url.href;
}

async function copy(field, button) {
  field.select();
  let isCopied = false;
  try {
    await navigator.clipboard.writeText(field.value);
    isCopied = true;
  } catch {  // pages by plain http from elsewhere have no clipboard, only what is selected
    isCopied = document.execCommand('copy');
  }
  button.textContent = isCopied ? 'Copied' : 'Selected';
  setTimeout(() => { button.textContent = 'Copy'; }, 1500);
}

export class Commands {
  constructor() {
    for (const name of ['watch', 'still', 'socket']) {
      const [field, button] = [byId(`command-${name}`), byId(`copy-${name}`)];
      button.addEventListener('click', () => copy(field, button));
      field.addEventListener('focus', () => field.select());
    }
  }

  // parameters: URLSearchParams of /ws; kind: 'quilt', 'integral' or 'rgbd'
  show(parameters, kind) {
    // The address of a still names a preset, or says how the views of a quilt lie.
    const hasStill = kind === 'quilt' || parameters.has('preset');
    byId('still-elsewhere').hidden = !hasStill;
    const texts = {
      watch: watchCommand(parameters, kind),
      still: hasStill ? stillCommand(parameters) : '',
      socket: socketAddress(parameters),
    };
    for (const [name, text] of Object.entries(texts)) {
      if (byId(`command-${name}`).value !== text) byId(`command-${name}`).value = text;
    }
  }
}
