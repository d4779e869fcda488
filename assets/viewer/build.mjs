// Bundles the viewer and compresses it: writes ../viewer.js.gz, which is a part of the program, and ../viewer.sha256, by which
// pages know their own script. With --check it only says whether these files hold what these sources make.
import { buildSync } from 'esbuild';
import { createHash } from 'node:crypto';
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
// inside a script nothing may look like its end
const made = Buffer.from(outputFiles[0].text.replaceAll('</script', '<\\/script'));
const hash = `${createHash('sha256').update(made).digest('base64')}\n`;
const [file, hashFile] = ['viewer.js.gz', 'viewer.sha256'].map((name) => `${here}../${name}`);
if (process.argv.includes('--check')) {
  const kept = gunzipSync(readFileSync(file));
  if (!kept.equals(made) || readFileSync(hashFile, 'utf8') !== hash) {
    console.error('assets/viewer.js.gz, or its hash, is not what its sources make: run npm run build in assets/viewer');
    process.exit(1);
  }
} else {
  const packed = gzipSync(made, { level: 9 });
  writeFileSync(file, packed);
  writeFileSync(hashFile, hash);
  console.log(`${made.length} bytes, ${packed.length} compressed`);
}
