// SPDX-License-Identifier: Apache-2.0
// Keys that choose a mode or unfold the diagnostics, and what the picture's own keys do.
import {describeKey, onKey} from './shortcuts.js';

const byId = (id) => document.getElementById(id);

export function offerModeKeys(modes) {
  modes.radios.forEach((radio, index) => {
    onKey(String(index + 1), () => modes.choose(radio.value));
  });
  describeKey('1 – 6', 'modes, from left to right');
  onKey('q', () => modes.choose(modes.mode === 'quilt' ? 'look' : 'quilt'), 'quilt, and back');
  describeKey('← →', 'one view on, in the picture');
  describeKey('Page ↑ ↓', 'several views on');
  describeKey('Home, End', 'first and last view');
  describeKey('↑ ↓, Shift ← →', 'turn about the scene');
  describeKey('W S', 'step forward and back');
  describeKey('A D E X', 'move left, right, up, down');
  describeKey('0', 'back to where the eye was');
  onKey('i', () => {
    byId('diagnostics').open = !byId('diagnostics').open;
    if (byId('panel').hidden) byId('details').click();
  }, 'diagnostics');
}
