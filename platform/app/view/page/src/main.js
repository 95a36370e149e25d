// The page of dicot view: one board, one snapshot, and what a person does with it.
import { canShow, coloursOf, viridis } from "./colours.js";
import { decodeCloud } from "./cloud.js";
import { drawCurves } from "./curves.js";
import { showPlants, showRecord } from "./facts.js";
import { byId, counted, element, timeOf } from "./format.js";
import { Growth } from "./growth.js";
import { Measure } from "./measure.js";
import { Pictures } from "./pictures.js";
import { CloudScene } from "./scene.js";
import { readBytes, readJson } from "./source.js";
import { Timeline } from "./timeline.js";

const kModes = ["colour", "leaf", "height", "confidence"];
// The camera's own frame, until a ground is known.
const kNoPlace = { frame: { origin_mm: [0, 0, 0], right: [1, 0, 0], away: [0, 0, 1], up: [0, -1, 0], known: false }, grid: null };

const kPauseMs = 100; // whoever holds an arrow key down does not want every snapshot measured

const state = { board: 0, mode: "colour", plantsAlone: false, leaf: 0, seen: null, plants: null, work: 0, place: kNoPlace };
let scene, measure;

function say(message, { title = "", quiet = false } = {}) {
    const box = byId("message");
    box.hidden = message === "";
    box.classList.toggle("quiet", quiet);
    box.replaceChildren(...(title ? [element("b", "", title)] : []), message);
}

// The scene

function makeScene() {
    try {
        scene = new CloudScene(byId("scene"), () => measure?.draw());
    } catch {
        say("This browser shows no three dimensions (WebGL is off or missing); pictures, traits and curves are there.", { title: "No 3D" });
        return;
    }
    measure = new Measure(scene, byId("marks"), (words) => byId("readout").replaceChildren(words));
    const down = {};
    const canvas = byId("scene");
    canvas.addEventListener("pointerdown", (event) => Object.assign(down, { x: event.clientX, y: event.clientY }));
    canvas.addEventListener("click", (event) => {
        if (Math.hypot(event.clientX - down.x, event.clientY - down.y) > 4)
            return; // the cloud was turned
        const box = canvas.getBoundingClientRect();
        take(scene.pick(event.clientX - box.left, event.clientY - box.top));
    });
}

/// A person pointed at a point of the cloud, or (-1) beside it.
function take(i) {
    pictures.mark(i);
    if (measure?.on)
        measure.take(i);
    else
        choose(i >= 0 && state.plants ? state.plants.leaf[i] : 0);
}

function choose(leaf) {
    if (!state.seen || leaf === state.leaf)
        return;
    state.leaf = leaf;
    paint();
    showTraits();
}

function paint() {
    const { seen } = state;
    for (const button of document.querySelectorAll("[data-mode]")) {
        button.setAttribute("aria-pressed", String(button.dataset.mode === state.mode));
        button.disabled = seen !== null && !canShow(button.dataset.mode, seen);
    }
    if (!seen || !scene)
        return;
    scene.colour(coloursOf(state.mode, seen, { chosenLeaf: state.leaf, plantsAlone: state.plantsAlone }));
    drawLegend(seen);
}

function drawLegend(seen) {
    const legend = byId("legend");
    if (!canShow(state.mode, seen) || state.mode === "colour" || state.mode === "leaf") {
        const leaves = state.plants && state.mode === "leaf" ? counted(state.plants.facts.leaves.length, "leaf", "leaves") : "";
        legend.replaceChildren(leaves);
        return;
    }
    const bar = element("i");
    bar.style.background = `linear-gradient(90deg, ${[0, 0.2, 0.4, 0.6, 0.8, 1].map((t) => `rgb(${viridis(t)})`).join(", ")})`;
    const [name, ends] = state.mode === "height" ? ["height above the ground", ["0", `${Math.round(seen.highest)} mm`]] : ["confidence", ["0, a guess", "1"]];
    legend.replaceChildren(name, bar, element("div", "ends", ...ends.map((end) => element("span", "", end))));
}

/// mm above the ground; `highest`: of 99 in 100 points of the plants, or of all where there is none.
function heightsOf(cloud, { origin_mm: o, up: u }, plant) {
    const heights = new Float32Array(cloud.count);
    for (let i = 0; i < cloud.count; ++i)
        heights[i] = u[0] * (1000 * cloud.position[3 * i] - o[0]) + u[1] * (1000 * cloud.position[3 * i + 1] - o[1])
            + u[2] * (1000 * cloud.position[3 * i + 2] - o[2]);
    const ofPlants = heights.filter((_, i) => plant[i] > 0);
    const sorted = (ofPlants.length > 0 ? ofPlants : heights.slice()).sort();
    return { heights, highest: Math.max(sorted[Math.floor(sorted.length * 0.99)], 1) };
}

// A snapshot

async function show(index) {
    if (timeline.count === 0)
        return;
    const work = ++state.work; // whoever comes later is meant
    const current = () => work === state.work;
    timeline.select(index);
    const slot = timeline.slot(index);
    Object.assign(state, { seen: null, plants: null, leaf: 0 });
    byId("title").replaceChildren(element("b", "", `${slot.sequence}`), ` ${timeOf(slot.time)}`);
    byId("plants").replaceChildren();
    byId("record").replaceChildren();
    byId("legend").replaceChildren();
    measure?.turnOn(measure.on);
    growth.draw();
    pictures.clear();
    const folder = `data/${state.board}/${slot.sequence}`;
    if (slot.state !== "done") {
        scene?.clear();
        const titles = {
            missed: "This slot was missed", pruned: "Its folder was deleted to make room", quarantine: "Its folder was damaged, and is in quarantine",
            lost: "Its folder was taken away",
        };
        say(slot.reason, { title: titles[slot.state], quiet: true });
        if (slot.here)
            readJson(`${folder}/snapshot.json`).then((told) => current() && showRecord(byId("record"), told), () => {});
        return;
    }
    pictures.show(0, `${folder}/left.jpg`);
    say("");
    const told = await outcome(readJson(`${folder}/snapshot.json`));
    if (!current())
        return;
    const cloud = await outcome(readBytes(`${folder}/cloud.drc`).then(decodeCloud));
    if (!current())
        return;
    if (told.value)
        showRecord(byId("record"), told.value);
    if (cloud.error) {
        scene?.clear();
        const flaw = Object.values(told.value?.files ?? {}).find((words) => words !== "ok");
        say(flaw ? `${cloud.error} (${flaw})` : cloud.error, { title: "The cloud cannot be shown" });
    } else {
        state.seen = { cloud: cloud.value, plants: null, heights: null };
        // It stands where the one before stood until its own ground is known.
        scene?.show(cloud.value, state.place.frame, state.place.grid, () => false, state.place !== kNoPlace);
        paint();
    }
    await new Promise((resolve) => setTimeout(resolve, kPauseMs));
    if (!current())
        return;
    pictures.show(1, `${folder}/disparity.png`);
    const plants = await outcome(Promise.all([readJson(`${folder}/plants.json`), readBytes(`${folder}/leaves.bin`)]));
    if (!current())
        return;
    if (plants.error)
        byId("plants").replaceChildren(element("h2", "", "Plants"), element("p", "note", plants.error));
    else if (state.seen)
        addPlants(...plants.value);
    document.documentElement.dataset.ready = slot.sequence; // what a program that watches the page waits for
}

async function outcome(promise) {
    try {
        return { value: await promise };
    } catch (error) {
        return { error: error.message };
    }
}

function addPlants(facts, bytes) {
    const { cloud } = state.seen;
    if (bytes.length !== 3 * cloud.count)
        throw new Error("leaves.bin does not belong to this cloud");
    const leaf = new Uint16Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + 2 * cloud.count));
    state.plants = { facts, leaf, plant: bytes.subarray(2 * cloud.count) };
    state.seen.plants = state.plants;
    if (!facts.grid) { // too few points: it stands where the one before stood
        paint();
        showTraits();
        return;
    }
    const known = facts.ground.kind !== "none";
    if (known)
        Object.assign(state.seen, heightsOf(cloud, facts.ground, state.plants.plant));
    pictures.link(facts.grid, cloud);
    const keepView = state.place.grid !== null && state.place.frame.known === known;
    state.place = { frame: { ...facts.ground, known }, grid: facts.grid };
    scene?.show(cloud, state.place.frame, state.place.grid, (i) => state.plants.plant[i] > 0, keepView);
    paint();
    showTraits();
}

function showTraits() {
    if (state.plants)
        showPlants(byId("plants"), state.plants.facts, state.leaf, choose);
}

// What a person does

const step = (by) => timeline.count > 0 && show(Math.min(Math.max(timeline.current + by, 0), timeline.count - 1));

function setMode(mode) {
    state.mode = mode;
    paint();
}

function setPlantsAlone(alone) {
    state.plantsAlone = alone;
    byId("alone").setAttribute("aria-pressed", String(alone));
    paint();
}

function setMeasuring(on) {
    if (!measure)
        return;
    measure.turnOn(on);
    byId("measure").setAttribute("aria-pressed", String(on));
    if (on)
        byId("scene").focus();
}

function turnTheme() {
    const root = document.documentElement;
    root.dataset.theme = root.dataset.theme === "dark" ? "light" : "dark";
    scene?.background(getComputedStyle(root).getPropertyValue("--scene").trim());
}

const kKeys = {
    ArrowLeft: (event) => (event.shiftKey ? show(timeline.otherDay(-1)) : step(-1)),
    ArrowRight: (event) => (event.shiftKey ? show(timeline.otherDay(1)) : step(1)),
    Home: () => step(-Infinity),
    End: () => step(Infinity),
    m: () => setMeasuring(!measure?.on),
    Escape: () => (measure?.on ? setMeasuring(false) : choose(0)),
    a: () => scene?.turn(-0.1, 0),
    d: () => scene?.turn(0.1, 0),
    w: () => scene?.turn(0, 0.1),
    s: () => scene?.turn(0, -0.1),
    p: () => setPlantsAlone(!state.plantsAlone),
    "+": () => scene?.near(0.9),
    "-": () => scene?.near(1 / 0.9),
    f: () => scene?.front(),
    t: () => scene?.top(),
    l: () => state.plants && choose((state.leaf + 1) % (state.plants.facts.leaves.length + 1)),
    c: turnTheme,
    "?": () => byId("keys").showModal(),
};

function heedKeys(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || byId("keys").open || event.target.closest("select, input"))
        return;
    const at = kModes[Number(event.key) - 1];
    if (at)
        setMode(at);
    else if (!(measure?.on && !event.target.closest("button") && measure.key(event)) && kKeys[event.key])
        kKeys[event.key](event);
    else if (!event.key.startsWith("Arrow"))
        return;
    event.preventDefault();
}

function listen() {
    document.addEventListener("keydown", heedKeys);
    for (const button of document.querySelectorAll("[data-mode]"))
        button.addEventListener("click", () => setMode(button.dataset.mode));
    const clicks = {
        measure: () => setMeasuring(!measure?.on), alone: () => setPlantsAlone(!state.plantsAlone), front: () => scene?.front(), top: () => scene?.top(), theme: turnTheme,
        previous: () => step(-1), next: () => step(1), help: kKeys["?"], keys_close: () => byId("keys").close(),
    };
    for (const [id, act] of Object.entries(clicks))
        byId(id).addEventListener("click", act);
    byId("board").addEventListener("change", (event) => openBoard(Number(event.target.value)));
}

async function openBoard(board) {
    state.board = board;
    state.place = kNoPlace;
    const slots = await outcome(readJson(`data/${board}/slots.json`));
    if (slots.error) {
        say(slots.error, { title: "This board cannot be read" });
        return;
    }
    timeline.show(board, slots.value);
    document.body.classList.toggle("single", timeline.count === 1);
    growth.open(board);
    if (timeline.count === 0)
        say("dicot snap makes one.", { title: "There is no snapshot yet", quiet: true });
    else
        await show(newestDone());
}

function newestDone() {
    const at = timeline.slots.state.lastIndexOf("d");
    return at < 0 ? timeline.count - 1 : at;
}

function theme() {
    const root = document.documentElement;
    root.dataset.theme = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
    scene?.background(getComputedStyle(root).getPropertyValue("--scene").trim());
}

const timeline = new Timeline(byId("timeline"), byId("where"), show);
const pictures = new Pictures([byId("left"), byId("disparity")], take);
const growth = new Growth(timeline, drawCurves, (index) => show(index));

async function start() {
    makeScene();
    theme();
    listen();
    const archive = await outcome(readJson("data/archive.json"));
    if (archive.error) {
        say(archive.error, { title: "Nothing can be shown" });
        return;
    }
    const { boards, name } = archive.value;
    document.title = `${name} – dicot view`;
    if (boards.length > 1) {
        byId("board").append(...boards.map((board, i) => {
            const option = element("option", "", board.name);
            option.value = i;
            return option;
        }));
        byId("board").closest("label").hidden = false;
    }
    if (boards.length === 0)
        say("dicot snap or dicot pull brings some.", { title: "There is no snapshot here", quiet: true });
    else
        await openBoard(0);
}

start();
