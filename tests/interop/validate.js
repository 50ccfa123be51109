// Has Khronos' validator look at GLB files; fails on any error or warning.
const fs = require('fs');
const validator = require('gltf-validator');

async function main() {
  for (const file of process.argv.slice(2)) {
    const { issues, info } = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
    if (issues.numErrors + issues.numWarnings > 0) {
      console.log(file, JSON.stringify(issues.messages.slice(0, 5), null, 1));
      process.exit(1);
    }
    console.log(`gltf-validator: ${file} is valid, ${info.totalTriangleCount} triangles`);
  }
}
main();
