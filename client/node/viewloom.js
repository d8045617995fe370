// SPDX-License-Identifier: Apache-2.0
// The services of viewloom.v1, made from the protos when the program starts.
import {existsSync, readFileSync} from 'node:fs';
import {isIP} from 'node:net';
import {connect as connectTls} from 'node:tls';
import {fileURLToPath} from 'node:url';

import grpc from '@grpc/grpc-js';
import protoLoader from '@grpc/proto-loader';

// Beside this file in the package, at the top in a checkout.
const kProtoFolder = ['proto', '../../proto']
    .map((folder) => fileURLToPath(new URL(folder, import.meta.url)))
    .find((folder) => existsSync(`${folder}/viewloom/v1`));
const kServices = ['ingest', 'display', 'catalog'];

// Names of the codes that calls end with: error.code === status.NOT_FOUND.
export const {status} = grpc;

// The credentials of gRPC add a token on encrypted channels only.
function interceptorsOf(token) {
  if (token === '') return [];
  const addToken = (options, nextCall) => new grpc.InterceptingCall(nextCall(options), {
    start(metadata, listener, next) {
      metadata.set('authorization', `Bearer ${token}`);
      next(metadata, listener);
    },
  });
  return [addToken];
}

const kScheme = 'https://';
const kAnswer_ms = 5000;  // for a server to show its certificate

// The certificate that a server shows, whoever made it; the server has proved that it has its key.
function shownCertificate(target, own) {
  const at = target.lastIndexOf(':');
  const host = target.slice(0, at).replace(/^\[|\]$/g, '');
  return new Promise((resolve, reject) => {
    const socket = connectTls({
      host, port: Number(target.slice(at + 1)), servername: isIP(host) ? '' : host,
      ALPNProtocols: ['h2'], rejectUnauthorized: false, timeout: kAnswer_ms, ...own,
    });
    socket.once('secureConnect', () => {
      resolve(socket.getPeerCertificate());
      socket.destroy();
    });
    socket.once('error', reject);
    socket.once('timeout', () => {
      socket.destroy();
      reject(new Error(`${target} showed no certificate within ${kAnswer_ms} ms`));
    });
  });
}

function samePrint(one, other) {
  const digits = (text) => text.replace(/^sha256:/i, '').replaceAll(':', '').toUpperCase();
  return digits(one) === digits(other);
}

// Credentials for a server at https://HOST:PORT. `fingerprint`: SHA-256 of its certificate, by
// which it is known alone; it is asked for that certificate now. `ca`: file in PEM of the
// authorities of its certificate. `cert`, `key`: files in PEM that this client shows.
export async function tlsCredentials({server, fingerprint, ca, cert, key}) {
  if (!server.startsWith(kScheme)) {
    throw new Error(`${server} has no encryption; write the address as https://HOST:PORT`);
  }
  const target = server.slice(kScheme.length);
  const read = (file) => (file === undefined ? null : readFileSync(file));
  const own = {cert: read(cert) ?? undefined, key: read(key) ?? undefined};
  if (fingerprint === undefined) {
    return grpc.credentials.createSsl(read(ca), own.key, own.cert);
  }
  const shown = await shownCertificate(target, own);
  if (!samePrint(shown.fingerprint256, fingerprint)) {
    throw new Error(`the certificate of ${target} is not the pinned one; if the server has a new ` +
                    'certificate, give the fingerprint that the server itself prints');
  }
  const pem = `-----BEGIN CERTIFICATE-----\n${shown.raw.toString('base64')}\n` +
      '-----END CERTIFICATE-----\n';
  return grpc.credentials.createSsl(Buffer.from(pem), own.key, own.cert,
                                    {checkServerIdentity: () => undefined});
}

function credentialsOf(server) {
  return server.startsWith(kScheme) ? grpc.credentials.createSsl() :
                                      grpc.credentials.createInsecure();
}

// One client of a service: kind is 'IngestService', 'DisplayService' or 'CatalogService'. Fields
// keep their names in the protos; enums are strings, 64-bit integers too, as they exceed a number.
// `server`: HOST:PORT, or https://HOST:PORT with `credentials` of tlsCredentials(); without those,
// the server is known by the authorities that Node knows. `token`: access token that each call
// shows; '' is none.
export function connect(kind, {
  server = '127.0.0.1:50051', protos = kProtoFolder, credentials = credentialsOf(server),
  token = process.env.VIEWLOOM_TOKEN ?? '',
} = {}) {
  const definition = protoLoader.loadSync(
      kServices.map((name) => `viewloom/v1/${name}_service.proto`),
      {includeDirs: [protos], keepCase: true, enums: String, longs: String, defaults: true,
       oneofs: true});
  const Service = grpc.loadPackageDefinition(definition).viewloom.v1[kind];
  const target = server.startsWith(kScheme) ? server.slice(kScheme.length) : server;
  return new Service(target, credentials, {interceptors: interceptorsOf(token.trim())});
}

// When the next frame may be sent, at the rate at which the server uses frames.
export class SendPace {
  #interval_ms = 0;
  #sent_ms = -Infinity;

  // Frames a second, as wanted.rate_hz says; 0 = all are used.
  setRate(rate_hz) {
    this.#interval_ms = rate_hz > 0 ? 1000 / rate_hz : 0;
  }

  // Time until the next frame may be sent; not above 0 = now.
  leftMs() {
    return this.#sent_ms + this.#interval_ms - performance.now();
  }

  // A frame is sent now.
  note() {
    this.#sent_ms = performance.now();
  }
}
