// SPDX-License-Identifier: Apache-2.0
// The display that is watched: a message of proto Display as JSON, kept in the page's address.
import {keepInAddress, kParameters, nameOf, pageParameters} from './address.js';
import {enter} from './sign_in.js';

const kDefaultPreset = 'portrait';

// protobuf's JSON has two spellings of a name; here they are those of the proto.
function withProtoNames(value) {
  if (Array.isArray(value)) return value.map(withProtoNames);
  if (value === null || typeof value !== 'object') return value;
  return Object.fromEntries(Object.entries(value).map(([name, part]) => [
    name.replace(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`), withProtoNames(part)]));
}

function parsed(name) {
  const text = pageParameters().get(name);
  if (!text) return null;
  try {
    const value = withProtoNames(JSON.parse(text));
    if (value && typeof value === 'object' && !Array.isArray(value)) return value;
  } catch {
    // told below
  }
  throw new Error(`${name} in the page's address is no JSON object. ` +
                  `Take it out, or write it as {"quilt": {"preset": "portrait"}}.`);
}

// A name that no preset has: those there are lead out.
function unknownPreset(name, presets) {
  const known = presets.map((preset) => preset.name);
  const ways = known.map((text) => ({text, changes: {preset: text, display: null}}));
  return Object.assign(new Error(`The server has no preset "${name}". It has these:`), {ways});
}

// A field by its path: 'quilt.columns'; null takes it away.
export function put(display, path, value) {
  const names = path.split('.');
  const last = names.pop();
  let place = display;
  for (const name of names) place = place[name] ??= {};
  if (value === null) delete place[last];
  else place[last] = value;
  const parent = names.at(-1);  // one that holds nothing says nothing
  if (names.length === 1 && Object.keys(place).length === 0) delete display[parent];
}

export class DisplayDocument {
  #display = {};
  #encoding = {};
  #passing = {};  // by path: what nobody keeps

  // The document, or null where the address does not say a display: then onProblem(an Error with a
  // sentence, and `ways` as showTrouble() takes them).
  // Throws where the server does not answer. Waits until the page has signed in, if it must.
  static async ofAddress(onProblem) {
    await enter();
    const ask = async (path) => (await fetch(path)).json();
    const [{presets}, {fields}] = await Promise.all([ask('api/presets'), ask('api/fields')]);
    try {
      return new DisplayDocument(presets, fields);
    } catch (error) {
      onProblem(error);
      return null;
    }
  }

  // presets: as /api/presets lists them; ranges: of the fields, as /api/fields gives them
  constructor(presets, ranges) {
    this.presets = presets;
    this.ranges = ranges;
    const parameters = pageParameters();
    const unknown = [...parameters.keys()].filter((name) => !kParameters.includes(name));
    if (unknown.length > 0) {
      throw new Error(`The page does not know ${unknown.join(', ')} in its address. It knows ` +
                      `${kParameters.join(', ')}; a display is {"quilt": {...}} in display.`);
    }
    this.#encoding = parsed('encoding') ?? {};
    this.#display = parsed('display') ?? {preset: parameters.get('preset') ?? kDefaultPreset};
    const {preset, ...others} = this.#display;
    if (preset !== undefined) {  // a device of any kind
      this.#display = {[this.presetOf(preset)?.kinds[0] ?? 'quilt']: {preset}, ...others};
    }
    const named = preset ?? this.get(`${this.kind}.preset`);
    if (named !== undefined && !this.presetOf(named)) throw unknownPreset(named, presets);
    const [width, height] = ['width', 'height'].map((side) => Number(parameters.get(side)));
    const sizes = {quilt: 'size', rgbd: 'view_size'};
    const size = sizes[this.kind];
    if (width && height && size) put(this.#display, `${this.kind}.${size}`, {width, height});
  }

  // 'quilt', 'rgbd', ...
  get kind() {
    const others = ['world_pose', 'tolerance_px', 'outside_fill', 'background_rgb', 'effects',
      'filter', 'focus_following_s', 'quality'];
    return Object.keys(this.#display).find((name) => !others.includes(name)) ?? 'quilt';
  }

  get preset() { return this.presetOf(this.get(`${this.kind}.preset`)); }

  presetOf(name) { return this.presets.find((preset) => preset.name === name); }

  // A field by its path; undefined: left open.
  get(path) {
    return path.split('.').reduce((place, name) => place?.[name], this.whole);
  }

  // Changes by path, null = the default. isKept: also in the address.
  set(changes, isKept = true) {
    for (const [path, value] of Object.entries(changes)) {
      if (isKept) {
        put(this.#display, path, value);
        delete this.#passing[path];
      } else {
        this.#passing[path] = value;
      }
    }
    if (isKept) this.#keep();
  }

  // Another display; effects stay where its kind can have them.
  choose(kind, fields) {
    const effects = kind === 'rgbd' ? {} :
      {effects: this.#display.effects, quality: this.#display.quality};
    const following = kind === 'quilt' ? {focus_following_s: this.#display.focus_following_s} : {};
    this.#display = JSON.parse(JSON.stringify({[kind]: fields, ...effects, ...following}));
    this.#passing = {};
    this.#keep();
  }

  // Forgets the sliders' values for the display before.
  forgetPassing() { this.#passing = {}; }

  // A copy of the message, as somebody else is to watch it.
  get whole() {
    const display = structuredClone(this.#display);
    for (const [path, value] of Object.entries(this.#passing)) put(display, path, value);
    return display;
  }

  get encoding() { return structuredClone(this.#encoding); }

  // A name says it all, or the whole message does.
  #keep() {
    const name = nameOf(this.#display);
    keepInAddress({
      preset: name ?? null,
      display: name ? null : JSON.stringify(this.#display),
      width: null,
      height: null,
    });
  }
}
