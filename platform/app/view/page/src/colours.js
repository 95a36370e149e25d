// How points are coloured.

// Viridis (S. van der Walt, N. Smith, 2015), every sixteenth of its 256 colours.
const kViridis = ["440154", "481a6c", "472f7d", "414487", "39568c", "31688e", "2a788e", "23888e", "1f988b", "22a884",
    "35b779", "54c568", "7ad151", "a5db36", "d2e21b", "fde725"].map((hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16)));

const kStem = [150, 165, 150];
const kChosen = [255, 64, 160];

/// t in 0 .. 1.
export function viridis(t) {
    const at = Math.min(Math.max(t, 0), 1) * (kViridis.length - 1);
    const below = Math.min(Math.floor(at), kViridis.length - 2);
    return kViridis[below].map((value, i) => Math.round(value + (kViridis[below + 1][i] - value) * (at - below)));
}

/// Neighbouring numbers look different: steps of the golden angle around the colour circle.
export function leafColour(leaf) {
    const hue = (leaf * 137.508) % 360;
    const light = [0.62, 0.48, 0.72][leaf % 3];
    return [0, 8, 4].map((n) => {
        const k = (n + hue / 30) % 12;
        return Math.round(255 * (light - 0.75 * Math.min(light, 1 - light) * Math.max(-1, Math.min(k - 3, 9 - k, 1))));
    });
}

/// What is no plant stays to be seen, and steps back.
function greyOf(cloud, i) {
    const [r, g, b] = cloud.colour.subarray(3 * i, 3 * i + 3);
    const grey = 60 + (0.299 * r + 0.587 * g + 0.114 * b) / 2;
    return [grey, grey, grey];
}

const kPainters = {
    colour: ({ cloud }) => (i) => cloud.colour.subarray(3 * i, 3 * i + 3),
    leaf: ({ cloud, plants }) => (i) => (plants.leaf[i] ? leafColour(plants.leaf[i]) : plants.plant[i] ? kStem : greyOf(cloud, i)),
    height: ({ heights, highest }) => (i) => viridis(heights[i] / highest),
    confidence: ({ cloud }) => (i) => viridis(cloud.confidence[i]),
};

/// Four bytes a point, the last one 0 where it is hidden. `seen`: cloud, plants (null: not known), heights and highest in mm
/// (null: no ground). A mode for which something is missing is that of the true colours.
export function coloursOf(mode, seen, { chosenLeaf, plantsAlone }) {
    const painter = kPainters[canShow(mode, seen) ? mode : "colour"](seen);
    const colours = new Uint8Array(4 * seen.cloud.count);
    const { plants } = seen;
    for (let i = 0; i < seen.cloud.count; ++i) {
        colours.set(chosenLeaf && plants.leaf[i] === chosenLeaf ? kChosen : painter(i), 4 * i);
        colours[4 * i + 3] = plantsAlone && plants && plants.plant[i] === 0 ? 0 : 255;
    }
    return colours;
}

export function canShow(mode, seen) {
    return mode === "leaf" ? seen.plants !== null : mode === "height" ? seen.heights !== null : true;
}
