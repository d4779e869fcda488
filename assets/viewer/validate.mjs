// Says in JSON what the validator of glTF finds in a file.
//
//   node validate.mjs file.glb
import validator from 'gltf-validator';
import { readFileSync } from 'node:fs';

const { issues, info } = await validator.validateBytes(new Uint8Array(readFileSync(process.argv[2])));
console.log(JSON.stringify({ errors: issues.numErrors, warnings: issues.numWarnings, messages: issues.messages.slice(0, 5), animations: info.animationCount, triangles: info.totalTriangleCount }));
