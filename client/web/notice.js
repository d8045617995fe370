// SPDX-License-Identifier: Apache-2.0
// One sentence over the picture, said by screen readers too.

const kNoticeTime_ms = 6000;

const byId = (id) => document.getElementById(id);
let timer = 0;
let waiting = '';

// '' takes it away. kind: '' or 'bad'.
export function notice(text, kind = '', time_ms = kNoticeTime_ms) {
  clearTimeout(timer);
  byId('notice').textContent = text;
  byId('notice').dataset.kind = kind;
  if (text && time_ms !== Infinity) timer = setTimeout(() => notice(''), time_ms);
}

// If that is what stands there.
export function takeBack(text) {
  if (byId('notice').textContent === text) notice('');
}

// The connection is lost, for a reason, and comes back by itself.
export function noticeWaiting(reason) {
  const sentence = /[.!?]$/.test(reason) ? reason : `${reason}.`;
  waiting = `${sentence} Trying again.`;
  notice(waiting, 'bad', Infinity);
}

// It is back.
export function endWaiting() {
  takeBack(waiting);
}

// For those who do not see the picture.
export function say(text) {
  if (byId('said').textContent !== text) byId('said').textContent = text;
}
