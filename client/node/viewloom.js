// SPDX-License-Identifier: Apache-2.0
// The services of viewloom.v1, made from the protos when the program starts.
import {fileURLToPath} from 'node:url';

import grpc from '@grpc/grpc-js';
import protoLoader from '@grpc/proto-loader';

const kProtoFolder = fileURLToPath(new URL('../../proto', import.meta.url));
const kServices = ['ingest', 'display', 'catalog'];

// What every example takes on its command line.
export const kCommonOptions = {
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

// Runs an example; what a call ends with, or a bad option, is one line, and exit code 1.
export async function run(main) {
  try {
    await main();
  } catch (error) {
    // Of the server: the name of its status, and its message, which begins with the field.
    console.error(error.details === undefined ? error.message
                                              : `${grpc.status[error.code]}: ${error.details}`);
    process.exitCode = 1;
  }
}
