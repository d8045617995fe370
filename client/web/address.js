// SPDX-License-Identifier: Apache-2.0
// The page's address: its parameters are those of /ws, and the page's own.

const kOwn = ['detail', 'mode'];

// What the page has no control for is passed on as it is.
export function pageParameters() {
  return new URLSearchParams(location.search);
}

// Those for the server.
export function watchedParameters() {
  const parameters = pageParameters();
  for (const name of kOwn) parameters.delete(name);
  return parameters;
}

// A choice made by hand is kept, so that a reload and a link show the same; null = not there.
export function keepInAddress(changes) {
  const parameters = pageParameters();
  for (const [name, value] of Object.entries(changes)) {
    if (value === null) parameters.delete(name);
    else parameters.set(name, value);
  }
  history.replaceState(null, '', `?${parameters}`);
}
