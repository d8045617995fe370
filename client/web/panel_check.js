// SPDX-License-Identifier: Apache-2.0
// Whether what is woven reaches the panel px by px, and in one sentence why not.

// Aspects of devices' quilts and panels differ by so much at most: Portrait 0.75 and Go 0.5625.
const kAspectTolerance = 0.03;

const sizeText = ({width, height}) => `${width} × ${height}`;

// canvas_px: device px that the picture covers; layout: of the newest atlas, or null; scale:
// window.devicePixelRatio; side_max_px: of a texture. {ok, text}
export function checkPanel({calibration, layout, canvas_px, isFullScreen, scale, side_max_px}) {
  const wrong = (text) => ({ok: false, text});
  if (!calibration) {
    return wrong('The panel’s calibration is missing: drop or choose its visual.json.');
  }
  const panel_px = calibration.screen_px;
  if (layout && Math.max(layout.size.width, layout.size.height) > side_max_px) {
    return wrong(`The quilt of ${sizeText(layout.size)} px is larger than the ${side_max_px} px ` +
                 'this browser takes: choose less detail.');
  }
  if (!isFullScreen) {
    return wrong(`Move this window to the panel’s monitor (${sizeText(panel_px)} px) and press ` +
                 'Full screen.');
  }
  const {width, height} = canvas_px;
  if (width === panel_px.height && height === panel_px.width && width !== height) {
    return wrong(`The monitor is turned: it shows ${sizeText(canvas_px)} px, the panel has ` +
                 `${sizeText(panel_px)}: set its orientation in the system’s display settings.`);
  }
  if (width !== panel_px.width || height !== panel_px.height) {
    return wrong(`This monitor shows ${sizeText(canvas_px)} px, the panel has ` +
                 `${sizeText(panel_px)}: use the panel’s own monitor at its native resolution, ` +
                 `with scale and page zoom at 100 % (now ${Math.round(100 * scale)} %).`);
  }
  const aspect = width / height;
  if (layout && Math.abs(layout.aspect / aspect - 1) > kAspectTolerance) {
    return wrong(`Views of aspect ${layout.aspect.toFixed(2)} are stretched to the panel’s ` +
                 `${aspect.toFixed(2)}: choose the panel’s display above.`);
  }
  return {ok: true, text: `Woven for ${calibration.serial || 'the panel'}, px by px.`};
}
