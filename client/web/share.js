// SPDX-License-Identifier: Apache-2.0
// A QR code for phones and people without a token: a link to the display, which the server signs
// and which is good for ten minutes.
import {isOnLoopback, picturePath} from './address.js';
import {allow, kNoPicture} from './allowed.js';
import {copy} from './copy.js';
import {notice} from './notice.js';
import {onKey} from './shortcuts.js';

const kSeconds = 600;
const kLocal = 'Only this machine can open it: open this page by the name of the machine first.';

const byId = (id) => document.getElementById(id);

// {picture, address, end}: an SVG, the link that it shows, and when that expires.
async function askCode(asked) {
  const parameters = new URLSearchParams({
    target: `/${picturePath('stream', '.mjpg', asked)}`,
    seconds: kSeconds,
    page: new URL('.', location.href).href,
  });
  const reply = await fetch(`api/qr?${parameters}`, {cache: 'no-store'});
  const picture = await reply.text();
  if (!reply.ok) throw new Error(JSON.parse(picture).error.message);
  const document = new DOMParser().parseFromString(picture, 'image/svg+xml');
  const textOf = (name) => document.querySelector(name).textContent;
  return {picture, address: textOf('title'), end: new Date(textOf('desc'))};
}

export class Share {
  #asked = null;

  constructor() {
    allow(byId('share'), kNoPicture);
    byId('share').addEventListener('click', () => this.#open());
    byId('shared-close').addEventListener('click', () => this.#close());
    const [field, button] = [byId('shared-link'), byId('copy-shared')];
    button.addEventListener('click', () => copy(field, button));
    field.addEventListener('focus', () => field.select());
    onKey('escape', () => this.#close());
  }

  // asked: {stream, display, encoding}, what is shared.
  show(asked) {
    this.#asked = asked;
    allow(byId('share'), '');
  }

  async #open() {
    try {
      const {picture, address, end} = await askCode(this.#asked);
      this.#close();
      byId('shared-code').src =
          URL.createObjectURL(new Blob([picture], {type: 'image/svg+xml'}));
      byId('shared-link').value = address;
      byId('shared-end').textContent =
          `Good until ${end.toLocaleTimeString()}.${isOnLoopback() ? ` ${kLocal}` : ''}`;
      byId('shared').hidden = false;
      byId('shared-close').focus();
    } catch (error) {
      notice(error.message, 'bad');
    }
  }

  #close() {
    byId('shared').hidden = true;
    URL.revokeObjectURL(byId('shared-code').src);
    byId('shared-code').removeAttribute('src');
    byId('shared-link').value = '';
  }
}
