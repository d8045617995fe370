// SPDX-License-Identifier: Apache-2.0
// Parts that the examples share: their options, and errors as one line.
import {fileURLToPath} from 'node:url';
import {parseArgs} from 'node:util';

const {connect, status, tlsCredentials} = await loadViewloom();
export {connect};

async function loadViewloom() {
  try {
    return await import('./viewloom.js');
  } catch (error) {
    if (error.code !== 'ERR_MODULE_NOT_FOUND') throw error;
    console.error('the packages of package.json are missing: run `npm ci --ignore-scripts` in ' +
                  fileURLToPath(new URL('.', import.meta.url)));
    process.exit(1);
  }
}

// Options of every example. The access token comes from the environment (VIEWLOOM_TOKEN): the
// command line of a process is open to all users of a machine.
const kCommonOptions = {
  server: {type: 'string', default: '127.0.0.1:50051'},
  stream: {type: 'string', default: 'demo'},
  protos: {type: 'string'},
  fingerprint: {type: 'string'},
  'tls-ca': {type: 'string'},
  'tls-cert': {type: 'string'},
  'tls-key': {type: 'string'},
};

// Nothing for a server without TLS, whose address has no https://.
function credentialsOf({server, fingerprint, 'tls-ca': ca, 'tls-cert': cert, 'tls-key': key}) {
  const hasTls = server.startsWith('https://') || fingerprint || ca || cert || key;
  return hasTls ? tlsCredentials({server, fingerprint, ca, cert, key}) : undefined;
}

// Text of a server or a file, without what would drive a terminal.
export function printable(text) {
  return text.replace(/[\p{Cc}\p{Cf}]/gu, (character) =>
    character === '\n' ? character : `\\u{${character.codePointAt(0).toString(16)}}`);
}

// The name of a call's status and its message, which begins with the field; of a server that is not
// there, where it was looked for and what to do.
function errorText({code, details}, server) {
  const isAbsent = code === status.UNAVAILABLE &&
      /No connection established|ECONNREFUSED|ENOTFOUND|Name resolution failed/.test(details);
  if (!isAbsent) return `${status[code]}: ${details}`;
  if (/certificate|altnames/i.test(details)) {
    return `the certificate of ${server} is not accepted: connect by a name that it has, and ` +
        `name its authority with --tls-ca FILE, or pin it with --fingerprint HEX (${details})`;
  }
  return `no viewloomd answers at ${server}: start one with \`viewloomd serve\` or ` +
      `\`deploy/demo.sh\`, or say where it is with --server HOST:PORT (${details})`;
}

// Runs an example: main(options). What a call ends with, or a bad option, is one line, and exit
// code 1.
export async function run(moreOptions, main) {
  let server = kCommonOptions.server.default;
  try {
    const {values: options} = parseArgs({options: {...kCommonOptions, ...moreOptions}});
    server = options.server;
    await main({...options, credentials: await credentialsOf(options)});
  } catch (error) {
    console.error(
        printable(error.details === undefined ? error.message : errorText(error, server)));
    process.exitCode = 1;
  }
}
