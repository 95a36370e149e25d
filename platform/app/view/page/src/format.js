// Figures and times for people, and elements to put them in: texts of a card are never read as HTML.

/// element("p", "class", children or text ...).
export function element(name, style, ...children) {
    const made = document.createElement(name);
    if (style)
        made.className = style;
    made.append(...children);
    return made;
}

export const byId = (id) => document.getElementById(id);

const utc = (seconds) => new Date(seconds * 1000).toISOString();
export const dayOf = (seconds) => (seconds === null ? "" : utc(seconds).slice(0, 10));
export const clockOf = (seconds) => (seconds === null ? "" : utc(seconds).slice(11, 16));
export const timeOf = (seconds) => (seconds === null ? "time not known" : `${dayOf(seconds)} ${utc(seconds).slice(11, 19)} UTC`);

export const mm = (value) => `${value.toFixed(1)} mm`;
export const counted = (count, one, several = `${one}s`) => `${count.toLocaleString("en")} ${count === 1 ? one : several}`;

/// "12.3 ± 0.4", with as many decimals as the uncertainty has a meaning; "–" of what could not be measured.
export function measured(trait, scale = 1) {
    if (!trait || trait.value === null)
        return "–";
    const sd = trait.sd === null ? null : trait.sd * scale;
    const value = trait.value * scale;
    const decimals = sd ? Math.min(Math.max(Math.ceil(-Math.log10(sd)), 0), 2) : Math.abs(value) < 100 ? 1 : 0;
    return value.toFixed(decimals) + (sd ? ` ± ${sd.toFixed(decimals)}` : "");
}
