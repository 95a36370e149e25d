// A trait of each plant over time: samples with their uncertainty, outliers hollow, a smooth curve with its band, gaps below.
import { clockOf, counted, dayOf, element, measured, timeOf } from "./format.js";
import { leafColour } from "./colours.js";

const kHeight = 150;
const kLeft = 56, kRight = 12, kTop = 8, kBottom = 30;
const kMostDots = 1500;
const kDay = 86400; // s
const kSvg = "http://www.w3.org/2000/svg";

function shape(name, attributes, words) {
    const made = document.createElementNS(kSvg, name);
    for (const [key, value] of Object.entries(attributes))
        made.setAttribute(key, value);
    if (words !== undefined) {
        const title = document.createElementNS(kSvg, name === "text" ? "tspan" : "title");
        title.textContent = words;
        made.append(title);
    }
    return made;
}

/// A round number of steps over a span: 1, 2 or 5 times a power of ten.
function ticks(least, most, about) {
    const raw = (most - least) / about || 1;
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= raw);
    const all = [];
    for (let at = Math.ceil(least / step) * step; at <= most + 1e-9 * step; at += step)
        all.push(at);
    return { all, decimals: Math.max(0, -Math.floor(Math.log10(step))) };
}

/// Midnights, UTC, as many days apart as there is room for; of less than a day both ends.
function timeTicks(first, last, most) {
    if (last - first <= kDay)
        return last > first ? [first, last] : [first];
    const step = Math.ceil((last - first) / kDay / most) * kDay;
    const all = [];
    for (let time = Math.ceil(first / kDay) * kDay; time <= last; time += step)
        all.push(time);
    return all;
}

const colourOf = (plant) => `rgb(${leafColour(plant + 1)})`;

/// `curves`: curves.json; `now`: time of the snapshot that is shown; `chosen(sequence)`: a person wants to see the snapshot of a
/// sample.
export function drawCurves(into, curves, key, now, chosen) {
    const width = Math.max(into.clientWidth, 200);
    const trait = curves.traits.find((one) => one.key === key);
    const series = curves.plants.map((plant) => plant.series[key]).filter(Boolean);
    const times = series.flatMap((one) => one.time_s).concat(curves.gaps.flatMap((gap) => [gap.from_s, gap.to_s])).filter((time) => time !== null);
    const values = series.flatMap((one) => one.value.concat(one.curve?.value ?? [])).filter((value) => value !== null);
    if (times.length === 0 || values.length === 0) {
        into.replaceChildren("Nothing was measured yet.");
        return;
    }
    const first = Math.min(...times), last = Math.max(...times);
    const least = Math.min(0, ...values), most = Math.max(...values) * 1.08 || 1;
    const x = (time) => kLeft + (last > first ? (time - first) / (last - first) : 0.5) * (width - kLeft - kRight);
    const inside = (at) => Math.min(Math.max(at, kTop), kHeight - kBottom); // a band may be wider than what is drawn
    const y = (value) => kHeight - kBottom - (value - least) / (most - least) * (kHeight - kTop - kBottom);
    const svg = shape("svg", { viewBox: `0 0 ${width} ${kHeight}`, role: "img", "aria-label": `${trait.name} over time` });

    const marks = ticks(least * trait.scale, most * trait.scale, 4);
    for (const at of marks.all) {
        svg.append(shape("line", { class: "axis", x1: kLeft, x2: width - kRight, y1: y(at / trait.scale), y2: y(at / trait.scale) }));
        svg.append(shape("text", { x: kLeft - 6, y: y(at / trait.scale) + 4, "text-anchor": "end" }, at.toFixed(marks.decimals)));
    }
    svg.append(shape("text", { x: 4, y: kTop + 4 }, trait.unit));
    for (const time of timeTicks(first, last, Math.max(1, Math.floor(width / 130))))
        svg.append(shape("text", { x: x(time), y: kHeight - 4, "text-anchor": x(time) > width - 60 ? "end" : x(time) < 60 ? "start" : "middle" },
            last - first > kDay ? dayOf(time) : `${dayOf(time).slice(5)} ${clockOf(time)}`));
    for (const { from_s: from, to_s: to, slots, reason } of curves.gaps)
        svg.append(shape("rect", { class: "gap", x: x(from) - 1, width: x(to) - x(from) + 2, y: kHeight - kBottom + 3, height: 4 },
            `${timeOf(from)} to ${timeOf(to)}, ${counted(slots, "slot")}: ${reason}`));
    curves.plants.forEach((plant, i) => plant.series[key] && drawPlant(svg, plant, plant.series[key], colourOf(i), x, y, inside, trait, chosen));
    if (now !== null && now >= first && now <= last)
        svg.append(shape("line", { class: "now", x1: x(now), x2: x(now), y1: kTop, y2: kHeight - kBottom }));
    into.replaceChildren(svg, ...series.length > 1 ? [names(curves.plants, key)] : []);
}

/// Which colour is whose.
function names(plants, key) {
    const all = element("p", "note");
    plants.forEach((plant, i) => {
        if (!plant.series[key])
            return;
        const swatch = element("i", "swatch");
        swatch.style.background = colourOf(i);
        all.append(swatch, `${plant.name} `);
    });
    return all;
}

function drawPlant(svg, plant, series, colour, x, y, inside, trait, chosen) {
    const { curve } = series;
    if (curve) {
        // Where the curve does not go over a gap its values are null: a piece a stretch.
        for (const piece of pieces(curve)) {
            const above = piece.map((i) => `${x(curve.time_s[i])},${inside(y(curve.value[i] + 2 * curve.sd[i]))}`);
            const below = piece.map((i) => `${x(curve.time_s[i])},${inside(y(curve.value[i] - 2 * curve.sd[i]))}`);
            svg.append(shape("polygon", { points: [...above, ...below.reverse()].join(" "), fill: colour, opacity: 0.18 }));
            svg.append(shape("polyline", {
                points: piece.map((i) => `${x(curve.time_s[i])},${y(curve.value[i])}`).join(" "), fill: "none", stroke: colour, "stroke-width": 1.6,
            }));
        }
    }
    const stride = Math.ceil(series.value.length / kMostDots);
    series.value.forEach((value, i) => {
        const outlier = series.outlier[i] === "1";
        if (value === null || (i % stride !== 0 && !outlier))
            return;
        const words = `${plant.name}, ${timeOf(series.time_s[i])}: ${measured({ value, sd: series.sd[i] }, trait.scale)} ${trait.unit}`
            + (outlier ? ", outlier" : "");
        const dot = shape("circle", {
            class: "dot", cx: x(series.time_s[i]), cy: y(value), r: 3, fill: outlier ? "none" : colour, stroke: colour, opacity: 0.8,
        }, words);
        dot.addEventListener("click", () => chosen(series.sequence[i]));
        svg.append(dot);
    });
}

function pieces(curve) {
    const all = [[]];
    curve.value.forEach((value, i) => {
        if (value === null)
            all.push([]);
        else
            all.at(-1).push(i);
    });
    return all.filter((piece) => piece.length > 1);
}
