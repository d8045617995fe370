// SPDX-License-Identifier: Apache-2.0
// The services of viewloom.v1, made from the protos when the program starts.
import {fileURLToPath} from 'node:url';
import {parseArgs} from 'node:util';

const [grpc, protoLoader] = await loadPackages();

const kProtoFolder = fileURLToPath(new URL('../../proto', import.meta.url));
const kServices = ['ingest', 'display', 'catalog'];

async function loadPackages() {
  try {
    const packages = await Promise.all([import('@grpc/grpc-js'), import('@grpc/proto-loader')]);
    return packages.map((one) => one.default);
  } catch (error) {
    if (error.code !== 'ERR_MODULE_NOT_FOUND') throw error;
    console.error('the packages of package.json are missing: run `npm ci --ignore-scripts` in ' +
                  fileURLToPath(new URL('.', import.meta.url)));
    process.exit(1);
  }
}

// What every example takes on its command line.
const kCommonOptions = {
  server: {type: 'string', default: '127.0.0.1:50051'},
  stream: {type: 'string', default: 'demo'},
  protos: {type: 'string', default: kProtoFolder},
};

// One client of a service: kind is 'IngestService', 'DisplayService' or 'CatalogService'. Fields
// keep their names in the protos; enums are strings, 64-bit integers too, as they exceed a number.
export function connect(kind, {server, protos}) {
  const definition = protoLoader.loadSync(
      kServices.map((name) => `viewloom/v1/${name}_service.proto`),
      {includeDirs: [protos], keepCase: true, enums: String, longs: String, defaults: true,
       oneofs: true});
  const Service = grpc.loadPackageDefinition(definition).viewloom.v1[kind];
  return new Service(server, grpc.credentials.createInsecure());
}

// Text of a server or a file, without what would drive a terminal.
export function printable(text) {
  return text.replace(/[\p{Cc}\p{Cf}]/gu, (character) =>
    character === '\n' ? character : `\\u{${character.codePointAt(0).toString(16)}}`);
}

// The name of a call's status and its message, which begins with the field; of a server that is not
// there, where it was looked for and what to do.
function errorText({code, details}, server) {
  const isAbsent = code === grpc.status.UNAVAILABLE &&
      /No connection established|ECONNREFUSED|ENOTFOUND|Name resolution failed/.test(details);
  if (!isAbsent) return `${grpc.status[code]}: ${details}`;
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
    await main(options);
  } catch (error) {
    console.error(
        printable(error.details === undefined ? error.message : errorText(error, server)));
    process.exitCode = 1;
  }
}
