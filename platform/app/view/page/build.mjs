// node build.mjs FOLDER: page.html, one file with all that it needs, and the policies that allow its parts alone: server.csp, files.csp.
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { build } from "esbuild-wasm";

const into = process.argv[2];
const bundled = await build({
    entryPoints: ["src/main.js", "style.css"],
    outdir: into,
    bundle: true,
    write: false,
    minify: true,
    legalComments: "inline",
    format: "iife",
    target: "es2022",
    loader: { ".wasm": "binary" },
    external: ["fs", "path"], // Draco's decoder asks for them under Node alone
});
// What would end the element that it stands in.
const text = (ending) => bundled.outputFiles.find((file) => file.path.endsWith(ending)).text.replaceAll("</", "<\\/");
const script = text(".js");
const style = text(".css");
const page = readFileSync("index.html", "utf8")
    .replace("/*style*/", () => style)
    .replace("/*script*/", () => script);
const digest = (part) => `'sha256-${createHash("sha256").update(part).digest("base64")}'`;
const own = `script-src ${digest(script)} 'wasm-unsafe-eval'`;
const common = ["default-src 'none'", `style-src ${digest(style)}`, "base-uri 'none'", "form-action 'none'"];
mkdirSync(into, { recursive: true });
writeFileSync(`${into}/page.html`, page);
writeFileSync(`${into}/server.csp`, [...common, own, "img-src 'self' data:", "connect-src 'self'", "frame-ancestors 'none'"].join("; "));
// An export's data are scripts beside the page; 'self' means no file to some browsers, file: nothing to a page from a server.
writeFileSync(`${into}/files.csp`, [...common, `${own} 'self' file:`, "img-src 'self' file: data:"].join("; "));
