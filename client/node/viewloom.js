// SPDX-License-Identifier: Apache-2.0
// The services of viewloom.v1, made from the protos when the program starts.
import {existsSync} from 'node:fs';
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

// One client of a service: kind is 'IngestService', 'DisplayService' or 'CatalogService'. Fields
// keep their names in the protos; enums are strings, 64-bit integers too, as they exceed a number.
// token: access token that each call shows; '' is none.
export function connect(kind, {server = '127.0.0.1:50051', protos = kProtoFolder,
                               token = process.env.VIEWLOOM_TOKEN ?? ''} = {}) {
  const definition = protoLoader.loadSync(
      kServices.map((name) => `viewloom/v1/${name}_service.proto`),
      {includeDirs: [protos], keepCase: true, enums: String, longs: String, defaults: true,
       oneofs: true});
  const Service = grpc.loadPackageDefinition(definition).viewloom.v1[kind];
  return new Service(server, grpc.credentials.createInsecure(),
                     {interceptors: interceptorsOf(token.trim())});
}
