// Bundles the viewer and compresses it: writes ../viewer.js.gz, which is a part of the program.
// With --check it only says whether that file holds what these sources make.
import { buildSync } from 'esbuild';
import { gzipSync, gunzipSync } from 'node:zlib';
import { readFileSync, writeFileSync } from 'node:fs';

const here = new URL('.', import.meta.url).pathname;
// the licences of what is bundled stay in the file
const licence = (name) => `${name}\n${readFileSync(`${here}node_modules/${name}/LICENSE`, 'utf8').trim()}`;
const footer = `/*!\n${['three', 'uplot'].map(licence).join('\n\n')}\n*/`;
const { outputFiles } = buildSync({
  entryPoints: [here + 'src/main.js'],
  bundle: true,
  minify: true,
  format: 'iife',
  target: 'es2022',
  charset: 'utf8',
  legalComments: 'eof',
  footer: { js: footer },
  loader: { '.css': 'text' },
  write: false,
});
const made = Buffer.from(outputFiles[0].contents);
const file = here + '../viewer.js.gz';
if (process.argv.includes('--check')) {
  const kept = gunzipSync(readFileSync(file));
  if (!kept.equals(made)) {
    console.error('assets/viewer.js.gz is not what its sources make: run npm run build in assets/viewer');
    process.exit(1);
  }
} else {
  const packed = gzipSync(made, { level: 9 });
  writeFileSync(file, packed);
  console.log(`${made.length} bytes, ${packed.length} compressed`);
}
