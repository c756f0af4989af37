// Bundles the front end into the Python package; with --tests, the unit tests into build/tests.
import { build } from "esbuild";
import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const target = join(here, "..", "src", "rigid", "report", "static");

const common = { absWorkingDir: here, bundle: true, logLevel: "warning" };

/** The licences of everything bundled: they must travel with every report. */
function notices(metafile) {
  const packages = new Set();
  for (const path of Object.keys(metafile.inputs)) {
    const match = /^node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(path);
    if (match) packages.add(match[1]);
  }
  const texts = [...packages].sort().map((name) => {
    const folder = join(here, "node_modules", name);
    const own = readdirSync(folder).find((f) => /^licen[cs]e(\.(md|txt))?$/i.test(f));
    // A package that comes without its licence's text: we keep it, from its repository.
    const file = own ? join(folder, own) : join(here, "licences", `${name}.txt`);
    if (!existsSync(file)) throw new Error(`no licence text for the bundled package ${name}`);
    const { version } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
    return `${name} ${version}\n\n${readFileSync(file, "utf8").trim()}`;
  });
  const body = texts.join("\n\n----\n\n").replaceAll("*/", "* /").replace(/[^\x00-\x7f]/g, "?");
  return `/*! Third-party software in this file\n\n${body}\n*/\n`;
}

/** One page, `<name>.js` and `<name>.css`. */
async function bundlePage(name, entry) {
  const result = await build({
    ...common,
    entryPoints: { [name]: entry },
    outdir: target,
    write: false,
    metafile: true,
    minify: true,
    format: "iife",
    target: ["es2022"],
    legalComments: "none",
  });
  mkdirSync(target, { recursive: true });
  for (const file of result.outputFiles) {
    const isScript = file.path.endsWith(".js");
    writeFileSync(file.path, isScript ? file.text + notices(result.metafile) : file.text);
    console.log(`${basename(file.path)} ${(file.contents.length / 1024).toFixed(0)} kB`);
  }
}

async function bundleTests() {
  const outdir = join(here, "build", "tests");
  rmSync(outdir, { recursive: true, force: true });
  const entryPoints = readdirSync(join(here, "tests"))
    .filter((name) => name.endsWith(".test.ts"))
    .map((name) => join("tests", name));
  await build({ ...common, entryPoints, outdir, platform: "node", format: "esm", outExtension: { ".js": ".mjs" } });
}

if (process.argv.includes("--tests")) await bundleTests();
else {
  await bundlePage("report", "src/report/main.ts");
  await bundlePage("study", "src/study/main.ts");
}
