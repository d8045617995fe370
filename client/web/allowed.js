// SPDX-License-Identifier: Apache-2.0
// Controls that can do nothing now: switched off, with the reason where somebody meets them.
import {notice} from './notice.js';

export const kNoPicture = 'There is no picture yet.';

const labelsOf = (control) => [control, ...(control.labels ?? [])];

// reason: why it can do nothing, a sentence; '' = it can. The control and its labels show the
// reason under the pointer, screen readers say it, and a tap on a label shows it.
export function allow(control, reason) {
  control.disabled = reason !== '';
  if ((control.dataset.reason ?? '') === reason) return;
  control.dataset.reason = reason;
  control.ariaDescription = reason;
  for (const part of labelsOf(control)) {
    part.dataset.title ??= part.title;  // what it says as long as it can
    part.title = reason || part.dataset.title;
  }
}

// Browsers give a control that is switched off no clicks, but what it stands in.
document.addEventListener('click', ({target}) => {
  const place = target.closest('label, .holder');
  const control = place?.control ?? place?.querySelector('[data-reason]');
  if (control?.disabled && control.dataset.reason) notice(control.dataset.reason);
});
