// node page.mjs SCENARIO PROGRAM SCENE: one promise of the page, held in a real browser. Exit code 0 if it holds.
//
// SCENE is what view_page_test.cpp makes: `store` with the slots 1 (done), 2 (missed), 3 (done, its cloud damaged), 4 (done);
// `known.drc`, a grey wall with a red and a blue patch whose distance is 314.36 mm; `exported`, the store as files; `beds`, two days of a
// plant with four leaves, and `beds.csv`, its name.
import { existsSync } from "node:fs";
import { check, histogram, middleOf, open, pixels, ready, serve } from "./browser.mjs";

const [, , scenario, program, scene] = process.argv;
const kKnownMm = 314.36;
const isRed = (r, g, b) => r > 200 && g < 60 && b < 60;
const isBlue = (r, g, b) => b > 200 && r < 60 && g < 60;

const distanceIn = async (page) => Number((await page.locator("#readout").textContent()).match(/^([\d.]+) mm/)?.[1]);

async function fourthSlot(words) {
    const { url, server } = await serve(program, `${scene}/store`);
    return { ...await open(url, words), url, server };
}

const scenarios = {
    async loads() {
        const { page, noted, url } = await fourthSlot();
        await ready(page, 4);
        check("the title names the snapshot", (await page.locator("#title").textContent()).startsWith("4 20"), await page.locator("#title").textContent());
        const colours = histogram(await pixels(page));
        check("the cloud has many colours", colours.size > 50, colours.size);
        const pictures = await page.$$eval("figure img", (images) => images.map((image) => image.complete && image.naturalWidth));
        check("both pictures are there", pictures.every((width) => width > 0), pictures);
        check("nothing goes to another computer", noted.requests.every((request) => request.startsWith(url) || request.startsWith("data:")), noted.requests);
        check("no error on the console", noted.errors.length === 0, noted.errors);
    },

    async colours() {
        const { page, noted } = await fourthSlot();
        await ready(page, 4);
        const seen = [];
        for (const [key, mode] of [["1", "colour"], ["4", "confidence"], ["3", "height"], ["2", "leaf"]]) {
            if (await page.locator(`[data-mode="${mode}"]`).isDisabled())
                continue; // the scene has no ground
            await page.keyboard.press(key);
            check("the button tells", await page.locator(`[data-mode="${mode}"]`).getAttribute("aria-pressed") === "true", mode);
            seen.push(JSON.stringify([...histogram(await pixels(page))].sort()));
        }
        check("each mode is another picture", seen.length >= 3 && new Set(seen).size === seen.length, seen.length);
        check("no error on the console", noted.errors.length === 0, noted.errors);
    },

    async measures() {
        const { url } = await serve(program, `${scene}/known.drc`);
        const { page, noted } = await open(url);
        await ready(page, 7);
        await page.keyboard.press("m");
        const picture = await pixels(page);
        for (const like of [isRed, isBlue])
            await page.locator("#scene").click({ position: middleOf(picture, like) });
        check("clicked", Math.abs(await distanceIn(page) - kKnownMm) <= 0.2, await page.locator("#readout").textContent());
        console.log(`    measured ${await distanceIn(page)} mm of ${kKnownMm}`);

        // The same with the keyboard alone, from the middle of the canvas.
        await page.keyboard.press("m");
        await page.keyboard.press("m");
        const at = { x: picture.width / 2, y: picture.height / 2 };
        for (const like of [isBlue, isRed]) {
            const to = middleOf(picture, like);
            for (const [axis, keys] of [["x", ["ArrowLeft", "ArrowRight"]], ["y", ["ArrowUp", "ArrowDown"]]])
                for (; Math.abs(to[axis] - at[axis]) >= 1; at[axis] += 2 * Math.sign(to[axis] - at[axis]))
                    await page.keyboard.press(keys[Number(to[axis] > at[axis])]);
            await page.keyboard.press("Enter");
        }
        check("by keyboard", Math.abs(await distanceIn(page) - kKnownMm) <= 0.2, await page.locator("#readout").textContent());
        check("no error on the console", noted.errors.length === 0, noted.errors);
    },

    async damaged() {
        const { page, noted } = await fourthSlot();
        await ready(page, 4);
        await page.keyboard.press("ArrowLeft");
        await ready(page, 3);
        const message = page.locator("#message");
        check("a sentence tells", /cannot be shown.*damaged/s.test(await message.textContent()), await message.textContent());
        await page.keyboard.press("ArrowLeft");
        await page.waitForFunction(() => document.querySelector("#message").textContent.includes("missed"));
        check("a miss has its reason", (await message.textContent()).includes("is gone"), await message.textContent());
        await page.keyboard.press("ArrowLeft");
        await ready(page, 1);
        check("the next snapshot is shown", await message.isHidden() && histogram(await pixels(page)).size > 50, await message.textContent());
        check("no script failed", noted.errors.every((error) => error.startsWith("Failed to load resource")), noted.errors);
    },

    async keyboard() {
        const { page, noted } = await fourthSlot();
        await ready(page, 4);
        const before = JSON.stringify([...histogram(await pixels(page))]);
        await page.keyboard.press("d");
        await page.keyboard.press("d");
        check("d turns the cloud", JSON.stringify([...histogram(await pixels(page))]) !== before, "the same pixels");
        await page.keyboard.press("f");
        check("f turns it back", JSON.stringify([...histogram(await pixels(page))]) === before, "other pixels");
        await page.keyboard.press("?");
        check("? shows the keys", await page.locator("#keys").isVisible(), "hidden");
        await page.keyboard.press("Escape");
        check("Escape hides them", !await page.locator("#keys").isVisible(), "visible");
        await page.keyboard.press("Home");
        await ready(page, 1);
        await page.keyboard.press("End");
        await ready(page, 4);
        await page.keyboard.press("c");
        check("c turns dark", await page.evaluate(() => document.documentElement.dataset.theme) === "dark", "light");
        const unnamed = await page.$$eval("button, select, input, canvas, [role=option]", (all) => all.filter((one) =>
            !(one.getAttribute("aria-label") || one.textContent.trim() || one.labels?.length)).map((one) => one.outerHTML));
        check("everything that can be reached has a name", unnamed.length === 0, unnamed);
        check("no error on the console", noted.errors.every((error) => error.startsWith("Failed to load resource")), noted.errors);
    },

    async plants() {
        const { url } = await serve(program, `${scene}/beds`, "--plants", `${scene}/beds.csv`);
        const { page, noted } = await open(url);
        await ready(page, 2);
        await page.waitForFunction(() => document.querySelectorAll("#plants summary").length > 0);
        const names = await page.$$eval("#plants summary", (all) => all.map((one) => one.textContent));
        check("plants are called as the table says, in its words alone", JSON.stringify(names) === JSON.stringify(["<i>basil</i>", "empty"]), names);
        const leaves = await page.locator("#plants details").first().locator("table.leaves button").count();
        check("the leaves stand with their plant", leaves === 4, leaves);
        await page.waitForFunction(() => document.querySelectorAll("#curves circle").length > 0);
        const curves = await page.locator("#curves").innerHTML();
        check("so does the curve", curves.includes("&lt;i&gt;basil&lt;/i&gt;"), curves);
        check("no error on the console", noted.errors.length === 0, noted.errors);
    },

    async phone() {
        const { page } = await fourthSlot({ viewport: { width: 360, height: 740 }, hasTouch: true, isMobile: true, colorScheme: "dark" });
        await ready(page, 4);
        const width = await page.evaluate(() => document.documentElement.scrollWidth);
        check("nothing is wider than the screen", width <= 360, width);
        const scene = await page.locator("#scene").boundingBox();
        check("the cloud is in sight", scene.width > 300 && scene.height > 200 && scene.y < 100, scene);
        const overlapping = await page.$$eval(".tools", ([one, other]) => one.getBoundingClientRect().bottom > other.getBoundingClientRect().top
            && one.getBoundingClientRect().right > other.getBoundingClientRect().left);
        check("buttons stand beside each other", !overlapping, overlapping);
        await page.locator("#measure").tap();
        await page.locator("#scene").tap({ position: { x: scene.width / 2, y: scene.height / 2 } });
        const said = await page.locator("#readout").textContent();
        check("a tap sets a point", said.startsWith("First point set"), said);
        await page.locator("#previous").tap();
        await ready(page, 3);
    },

    async exported() {
        const { page, noted } = await open(`file://${scene}/exported/index.html`);
        await ready(page, 4);
        check("the cloud is drawn", histogram(await pixels(page)).size > 50, "few colours");
        await page.keyboard.press("ArrowLeft");
        await ready(page, 3);
        check("a damaged cloud is told", (await page.locator("#message").textContent()).includes("damaged"), await page.locator("#message").textContent());
        await page.keyboard.press("Home");
        await ready(page, 1);
        const pictures = await page.$$eval("figure img", (images) => images.map((image) => image.complete && image.naturalWidth));
        check("both pictures are there", pictures.every((width) => width > 0), pictures);
        check("nothing is asked for on a network", noted.requests.every((request) => /^(file|data):/.test(request)), noted.requests);
        check("no script failed", noted.errors.every((error) => error.startsWith("Failed to load resource")), noted.errors);
        const ran = await page.evaluate(() => {
            document.head.append(Object.assign(document.createElement("script"), { textContent: "globalThis.strange = true" }));
            return globalThis.strange === true;
        });
        check("a script that is not its own does not run", !ran && noted.errors.some((error) => /Content Security Policy/.test(error)), noted.errors);
    },

    async season() {
        const kSlots = 10_000;
        const slots = { sequence: [], time_s: [], state: "", reason: [], reasons: ["the camera is gone"] };
        for (let i = 0; i < kSlots; ++i) {
            slots.sequence.push(i + 1);
            slots.time_s.push(1_780_000_000 + 3600 * i);
            slots.state += i % 10 === 3 ? "m" : "d";
            slots.reason.push(i % 10 === 3 ? 0 : -1);
        }
        const before = (page) => page.route("**/slots.json", (route) => route.fulfill({ json: slots }));
        const { page } = await fourthSlot({ before });
        await page.waitForFunction(() => document.querySelector("#title").textContent.startsWith("10000"));
        const items = () => page.locator("#timeline [role=option]").count();
        check("what is out of sight is no element", await items() < 40, await items());
        await page.locator("#where").fill("5000");
        await page.waitForFunction(() => document.querySelector("#slot5000[aria-selected=true]") !== null);
        await page.locator("#slot5003").click();
        const message = await page.locator("#message").textContent();
        check("a miss of long ago has its reason", message.includes("the camera is gone"), message);
        check("still few elements", await items() < 40, await items());
    },

    async look() { // no promise: a picture for people, SCENE is what is to be looked at, the fourth word the picture
        const { url } = await serve(program, scene);
        const { page } = await open(url, { viewport: { width: 1400, height: 900 } });
        await page.waitForFunction(() => document.documentElement.dataset.ready, null, { timeout: 60_000 });
        await page.screenshot({ path: process.argv[5], type: "jpeg", quality: 80 });
    },
};

check("the scene is there", existsSync(scene), scene);
await scenarios[scenario]();
process.exit(0);
