// SPDX-License-Identifier: Apache-2.0
// The picture and its tools on the whole screen.
import {onKey} from './shortcuts.js';

const button = document.getElementById('fullscreen');

export function offerFullScreen() {
  button.hidden = !document.fullscreenEnabled;  // phones that fill theirs anyway
  button.addEventListener('click', () => {
    if (document.fullscreenElement) document.exitFullscreen();
    else document.querySelector('main').requestFullscreen();
  });
  onKey('f', () => button.click(), 'full screen, and back');
}
