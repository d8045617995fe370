// SPDX-License-Identifier: Apache-2.0
// The page's address: what is watched, as /ws takes it, and the page's own choices.

// Parameters of the page: how much detail, which way to look, late reprojection on or off. The
// others are those of /ws.
export const kParameters = ['stream', 'preset', 'width', 'height', 'display', 'encoding', 'detail',
  'mode', 'reprojection'];

export function pageParameters() {
  return new URLSearchParams(location.search);
}

// Whether this page comes from the machine on which it is shown.
export function isOnLoopback() {
  return ['localhost', '127.0.0.1', '[::1]'].includes(location.hostname);
}

// The page's address with other parameters; null = not there.
export function addressWith(changes) {
  const parameters = pageParameters();
  for (const [name, value] of Object.entries(changes)) {
    if (value === null) parameters.delete(name);
    else parameters.set(name, value);
  }
  return `?${parameters}`;
}

// A choice made by hand is kept, so that a reload and a link show the same; null = not there.
export function keepInAddress(changes) {
  history.replaceState(null, '', addressWith(changes));
}

// The name of a device, where that says all of a display; undefined elsewhere.
export function nameOf(display) {
  const [kind, ...others] = Object.values(display);
  return others.length === 0 && Object.keys(kind).length === 1 ? kind.preset : undefined;
}

// "ws?stream=...&display=...": asked is {stream, display, encoding, accepted}, the latter messages
// as JSON. All addresses of the server are relative, since a proxy may serve it below a path.
export function askedPath({stream, display, encoding, accepted}) {
  const parameters = new URLSearchParams({stream});
  const name = nameOf(display);
  if (name) parameters.set('preset', name);
  else parameters.set('display', JSON.stringify(display));
  if (Object.keys(encoding).length > 0) parameters.set('encoding', JSON.stringify(encoding));
  if (accepted) parameters.set('accepted', JSON.stringify(accepted));
  return `ws?${parameters}`;
}

// "still/STREAM/portrait" or "stream/STREAM.mjpg?display=...": the picture of a display. root:
// 'still' or 'stream', extension: '.jpg' or '.mjpg'.
export function picturePath(root, extension, {stream, display, encoding}) {
  const name = nameOf(display);
  const path = name ? `/${encodeURIComponent(name)}` : extension;
  const parameters = new URLSearchParams();
  if (!name) parameters.set('display', JSON.stringify(display));
  if (Object.keys(encoding).length > 0) parameters.set('encoding', JSON.stringify(encoding));
  const query = parameters.toString();
  return `${root}/${encodeURIComponent(stream)}${path}${query && `?${query}`}`;
}
