// SPDX-License-Identifier: Apache-2.0
// The switch for a lens before every view, in focus at the focal plane.
import {keepInAddress, pageParameters} from './address.js';

export class LensSwitch {
  // onChange({aperture_m}): a parameter of /ws; null = everything is sharp
  constructor(onChange) {
    const select = document.getElementById('lens');
    const aperture_m = pageParameters().get('aperture_m');
    if (aperture_m !== null) {
      const isListed = [...select.options].some(({value}) => value === aperture_m);
      if (!isListed) select.add(new Option(`${aperture_m} m`, aperture_m));
      select.value = aperture_m;
    }
    select.addEventListener('change', () => {
      const changes = {aperture_m: select.value || null};
      keepInAddress(changes);
      onChange(changes);
    });
  }

  // What the newest atlas was made with: colour with depth is sharp.
  show(layout) {
    document.getElementById('lens').disabled = !(layout.view_cone_rad > 0);
  }
}
