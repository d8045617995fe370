// SPDX-License-Identifier: Apache-2.0
// The switch for atlases between the frames of a stream.
import {keepInAddress, pageParameters} from './address.js';

const kRate_hz = '60';

export class BetweenFrames {
  // onChange({rate_hz, between}): parameters of /ws; null = an atlas a frame
  constructor(onChange) {
    const select = document.getElementById('between');
    const parameters = pageParameters();
    if (parameters.has('rate_hz')) select.value = parameters.get('between') ?? 'predict';
    select.addEventListener('change', () => {
      const between = select.value || null;
      const changes = {rate_hz: between && kRate_hz, between};
      keepInAddress(changes);
      onChange(changes);
    });
  }
}
