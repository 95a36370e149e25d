// A server of dicot view, and a real browser before it that notes whatever should not happen.
import { spawn } from "node:child_process";
import { chromium } from "playwright-core";

const kFlags = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"];
const kPatienceMs = 180_000; // the processors may have other work

export function check(what, holds, seen) {
    if (!holds)
        throw new Error(`${what}; seen: ${JSON.stringify(seen)}`);
}

/// The address of a server that ends with this process.
export async function serve(program, path, ...words) {
    const server = spawn(program, ["view", path, "--no-open", ...words], { stdio: ["ignore", "pipe", "inherit"] });
    process.on("exit", () => server.kill("SIGKILL"));
    const url = await new Promise((resolve, reject) => {
        server.stdout.once("data", (words) => resolve(String(words).split(/\s/)[0]));
        server.once("exit", (code) => reject(new Error(`dicot view ended with ${code}`)));
    });
    return { url, server };
}

export async function open(url, words = {}) {
    const browser = await chromium.launch({ executablePath: process.env.DICOT_CHROMIUM, args: kFlags });
    const context = await browser.newContext({ viewport: { width: 1280, height: 860 }, ...words });
    context.setDefaultTimeout(kPatienceMs);
    const page = await context.newPage();
    const noted = { errors: [], requests: [] };
    page.on("pageerror", (error) => noted.errors.push(error.message));
    page.on("console", (message) => ["error", "warning"].includes(message.type()) && !benign(message) && noted.errors.push(message.text()));
    page.on("request", (request) => noted.requests.push(request.url()));
    if (words.before)
        await words.before(page);
    await page.goto(url);
    return { browser, page, noted };
}

/// Of the software that draws for want of a graphics card, not of the page.
const benign = (message) => /GL Driver Message|GPU stall/.test(message.text());

export const ready = (page, sequence) =>
    page.waitForFunction((wanted) => document.documentElement.dataset.ready === wanted, String(sequence), { timeout: kPatienceMs });

/// The canvas as it is drawn: width, height, and four bytes a pixel.
export async function pixels(page) {
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    const shot = (await page.locator("#scene").screenshot()).toString("base64");
    const aside = await page.context().newPage(); // the page's own policy forbids what follows
    const picture = await aside.evaluate(async (base64) => {
        const picture = await createImageBitmap(await (await fetch(`data:image/png;base64,${base64}`)).blob());
        const canvas = new OffscreenCanvas(picture.width, picture.height);
        const context = canvas.getContext("2d");
        context.drawImage(picture, 0, 0);
        const { data } = context.getImageData(0, 0, picture.width, picture.height);
        let letters = "";
        for (let i = 0; i < data.length; i += 8192)
            letters += String.fromCharCode(...data.subarray(i, i + 8192));
        return { width: picture.width, height: picture.height, base64: btoa(letters) };
    }, shot);
    await aside.close();
    return { ...picture, bytes: Buffer.from(picture.base64, "base64") };
}

/// How many of each colour.
export function histogram({ bytes }) {
    const counts = new Map();
    for (let i = 0; i < bytes.length; i += 4) {
        const colour = `${bytes[i]},${bytes[i + 1]},${bytes[i + 2]}`;
        counts.set(colour, (counts.get(colour) ?? 0) + 1);
    }
    return counts;
}

/// The middle of all pixels that are like this; throws where there is none.
export function middleOf({ width, bytes }, like) {
    let count = 0, x = 0, y = 0;
    for (let i = 0; i < bytes.length; i += 4)
        if (like(bytes[i], bytes[i + 1], bytes[i + 2])) {
            ++count;
            x += (i / 4) % width;
            y += Math.floor(i / 4 / width);
        }
    check("pixels of this colour are drawn", count > 0, String(like));
    return { x: x / count + 0.5, y: y / count + 0.5 };
}
