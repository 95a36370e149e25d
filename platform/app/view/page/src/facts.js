// What is known of a snapshot: its plants, its leaves, its record.
import { leafColour } from "./colours.js";
import { element, measured } from "./format.js";

const kPlantRows = [
    ["height, 99th percentile", "height_p99_mm", "mm", 1],
    ["height, mean of the top tenth", "height_top10_mean_mm", "mm", 1],
    ["leaf area, visible", "leaf_area_visible_mm2", "cm²", 0.01],
    ["area seen from above", "projected_area_mm2", "cm²", 0.01],
    ["volume of the hull", "hull_volume_mm3", "cm³", 0.001],
    ["leaves", "leaf_count", "", 1],
    ["inclination, mean", "inclination_mean_deg", "°", 1],
];

const kLeafColumns = [
    ["length", "length_mm", 1], ["width", "width_mm", 1], ["area", "area_mm2", 0.01], ["incl.", "inclination_deg", 1],
];
// What depends on which way is up.
const kUpright = new Set(["height_p99_mm", "height_top10_mean_mm", "projected_area_mm2", "inclination_mean_deg", "inclination_deg"]);

const kLeafUnits = ["", "mm", "mm", "cm²", "°"];

function table(rows, style) {
    const made = element("table", style);
    made.append(...rows.map((cells) => {
        const row = element("tr");
        row.append(...cells.map((cell, i) => element(i === 0 ? "th" : "td", "", cell)));
        return row;
    }));
    return made;
}

/// `plants`: plants.json; `choose(leaf)`: a person wants to see this leaf.
export function showPlants(into, plants, chosenLeaf, choose) {
    const known = (key) => plants.ground.kind !== "none" || !kUpright.has(key);
    const parts = plants.plants.map((plant) => {
        const part = element("details", "plant", element("summary", "", plant.name, plant.cut ? element("em", "", "leaves the frame") : ""));
        part.open = plants.plants.length < 4;
        part.append(table(kPlantRows.filter(([, key]) => known(key)).map(([name, key, unit, scale]) => [name, `${measured(plant[key], scale)} ${unit}`])));
        const leaves = plants.leaves.filter((leaf) => leaf.plant === plant.plant);
        if (leaves.length > 0)
            part.append(leafTable(leaves, kLeafColumns.filter(([, key]) => known(key)), chosenLeaf, choose));
        return part;
    });
    const ground = { soil: "heights above the soil", bench: "heights above the bench", none: "no ground was found: heights and inclinations are not known" };
    const words = !plants.grid ? "There are too few points to find plants in." : plants.plants.length === 0 ? "No plant was found." : `${ground[plants.ground.kind]}; ± is one standard deviation`;
    into.replaceChildren(element("h2", "", "Plants"), element("p", "note", words), ...parts);
}

function leafTable(leaves, columns, chosenLeaf, choose) {
    const head = element("tr");
    head.append(...["leaf", ...columns.map(([name]) => name)].map((name, i) => element("th", "", name, element("small", "", ` ${kLeafUnits[i]}`))));
    const made = element("table", "leaves", head);
    for (const leaf of leaves) {
        const row = element("tr", leaf.leaf === chosenLeaf ? "chosen" : "");
        const swatch = element("i", "swatch");
        swatch.style.background = `rgb(${leafColour(leaf.leaf)})`;
        const flags = (leaf.hidden ? "partly hidden" : "") + (leaf.hidden && leaf.cut ? ", " : "") + (leaf.cut ? "leaves the frame" : "");
        const button = element("button", "", swatch, `${leaf.leaf}${flags ? "*" : ""}`);
        button.title = flags;
        button.setAttribute("aria-label", `Leaf ${leaf.leaf}${flags ? `, ${flags}` : ""}`);
        button.setAttribute("aria-pressed", String(leaf.leaf === chosenLeaf));
        button.addEventListener("click", () => choose(leaf.leaf === chosenLeaf ? 0 : leaf.leaf));
        row.append(element("th", "", button), ...columns.map(([, key, scale]) => {
            const cell = element("td", "", leaf[key].value === null ? "–" : (leaf[key].value * scale).toFixed(1));
            cell.title = measured(leaf[key], scale);
            return cell;
        }));
        made.append(row);
    }
    return made;
}

/// `snapshot`: snapshot.json.
export function showRecord(into, snapshot) {
    const { record, slot, files } = snapshot;
    const rows = slot.points === null ? [] : [["points", slot.points.toLocaleString("en")]];
    const add = (name, value, unit = "") => value !== undefined && value !== null && rows.push([name, `${value}${unit}`]);
    add("clock", slot.clock_trust);
    add("size", slot.bytes ? Math.round(slot.bytes / 1024).toLocaleString("en") : null, " KiB");
    add("method", record?.cloud?.method);
    add("skew", record?.shot?.skew_us, " µs");
    add("calibration", record?.calibration_id);
    add("source", record?.source);
    for (const [sensor, degrees] of Object.entries(record?.temperatures_c ?? {}))
        add(sensor, degrees, " °C");
    const flaws = Object.entries(files ?? {}).filter(([, outcome]) => outcome !== "ok").map(([, outcome]) => outcome);
    const warnings = Array.isArray(record?.warnings) ? record.warnings : [];
    into.replaceChildren(element("h2", "", "Record"), table(rows),
        ...[...flaws, ...warnings].map((words) => element("p", "flaw", String(words))));
}
