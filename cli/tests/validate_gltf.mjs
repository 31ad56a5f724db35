// Validates binary glTF files with the validator of Khronos, which is installed in the working folder:
// `npm install gltf-validator && node validate_gltf.mjs FILE..`

import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const validator = createRequire(`${process.cwd()}/`)('gltf-validator');

// Errors and warnings of a file.
async function complaints(bytes) {
  const { issues } = await validator.validateBytes(new Uint8Array(bytes));
  return issues.messages.filter(({ severity }) => severity < 2);
}

for (const path of process.argv.slice(2)) {
  const bytes = readFileSync(path);
  const found = await complaints(bytes);
  if (found.length > 0) throw new Error(`${path}: ${JSON.stringify(found, null, 1)}`);
  // The control: the first value of the buffer is a coordinate, and 1e9 m is beyond its declared bounds.
  const [length, header] = [bytes.readUInt32LE(12), 20];
  bytes.writeFloatLE(1e9, header + length + 8);
  const planted = await complaints(bytes);
  if (!planted.some(({ code }) => code === 'ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND')) throw new Error(`${path}: a planted fault is not found`);
  console.log(`${path}: valid`);
}
