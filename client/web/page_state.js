// SPDX-License-Identifier: Apache-2.0
// The state of the page: told to style sheets, tests and screen readers.
import {say} from './notice.js';

const root = document.documentElement;
const byId = (id) => document.getElementById(id);

// state: 'starting', 'no-stream', 'refused', 'connecting', 'live', 'reconnecting' or 'hidden';
// stream: its name; viewCount: 0 = not known yet
export function setState(state, stream = null, viewCount = 0) {
  root.dataset.state = state;
  byId('welcome').hidden = state !== 'no-stream';
  say({
    'live': `Live: ${stream}, views: ${viewCount || 'none yet'}.`,
    'connecting': `Connecting to ${stream}.`,
    'no-stream': 'No stream is live.',
  }[state] ?? '');
}

// position: of the eye in the cone, 0..1; viewCount: as above
export function nameView(position, viewCount) {
  const view = Math.round(position * (viewCount - 1));
  byId('ruler-view').textContent = viewCount ? `view ${view} of 0–${viewCount - 1}` : 'view –';
  byId('view').setAttribute('aria-valuetext', byId('ruler-view').textContent);
}

// On phones the place of the picture has its shape. layout: of the newest atlas, or null
export function shapePicture(layout, mode) {
  if (!layout) return;
  const {size, aspect} = layout;
  const shapes = {quilt: size.width / size.height, rgbd: 2 * aspect};
  root.style.setProperty('--aspect', (shapes[mode] ?? aspect).toFixed(3));
}
