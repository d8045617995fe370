// SPDX-License-Identifier: Apache-2.0
// One eye that follows the pointer, on a page of your own: look_around.html?server=HOST:PORT. The
// server has to name the origin of the page in http.allowed_origins (proto/web.md).
const parameters = new URLSearchParams(location.search);
const canvas = document.getElementById('view');
const display = {stereo: {layout: 'STEREO_LAYOUT_SINGLE', tracked: true,
  eye_size: {width: canvas.width, height: canvas.height}}};
const url = new URL(`ws://${parameters.get('server') ?? '127.0.0.1:8080'}/ws`);
url.searchParams.set('stream', parameters.get('stream') ?? 'demo');
url.searchParams.set('display', JSON.stringify(display));
const socket = new WebSocket(url);
socket.binaryType = 'arraybuffer';
const send = (message) => socket.readyState === 1 && socket.send(JSON.stringify(message));

socket.onmessage = async ({data}) => {
  if (typeof data === 'string') return console.warn(data);  // {"error": ...}
  const length = new DataView(data).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
  const jpeg = new Blob([new Uint8Array(data, 4 + length, header.jpeg_bytes)]);
  canvas.getContext('2d').drawImage(await createImageBitmap(jpeg), 0, 0);
  send({shown: header.delivery});  // only now the server sends another
  if (!header.eyes) return;        // no pose has come yet
  const age_ms = performance.now() - Number(header.eyes.time_ns) / 1e6;
  document.title = `motion to picture: ${age_ms.toFixed(0)} ms`;
};

canvas.onpointermove = ({offsetX, offsetY}) => {  // metres; the display looks along -z
  const position = {x: offsetX / canvas.width - 0.5, y: 0.5 - offsetY / canvas.height, z: 0};
  const time_ns = String(Math.round(performance.now() * 1e6));  // comes back with the picture
  send({eye_poses: {time_ns, eyes: [{pose: {position}}]}});
};
