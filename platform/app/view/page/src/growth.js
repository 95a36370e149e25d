// The curves of the board: asked for until all its snapshots are measured.
import { byId, counted, element } from "./format.js";
import { isExported, readJson } from "./source.js";

const kAgainMs = 3000;

export class Growth {
    /// `draw`: drawCurves(); `chosen(index)`: a person wants to see this slot.
    constructor(timeline, draw, chosen) {
        Object.assign(this, { timeline, paint: draw, chosen, curves: null, asked: 0 });
        byId("trait").addEventListener("change", () => this.draw());
        new ResizeObserver(() => this.draw()).observe(byId("curves"));
    }

    async open(board) {
        const asked = ++this.asked;
        this.curves = null;
        this.draw();
        for (;;) {
            let words = "";
            try {
                const curves = await readJson(`data/${board}/curves.json`);
                if (asked !== this.asked)
                    return;
                this.take(curves);
                words = curves.error ?? (curves.complete || curves.slots === 0 ? "" : `the newest ${counted(curves.slots, "slot")} so far`);
            } catch (error) {
                words = error.message;
            }
            byId("progress").textContent = words;
            if (!this.curves || this.curves.complete || isExported)
                return;
            await new Promise((resolve) => setTimeout(resolve, kAgainMs));
            if (asked !== this.asked)
                return;
        }
    }

    take(curves) {
        const select = byId("trait");
        if (select.options.length === 0)
            select.append(...curves.traits.map(({ key, name }) => {
                const option = element("option", "", name);
                option.value = key;
                return option;
            }));
        this.curves = curves;
        this.draw();
    }

    draw() {
        const { timeline, curves } = this;
        if (!curves) {
            byId("curves").replaceChildren();
            return;
        }
        const now = timeline.current < 0 ? null : timeline.slot(timeline.current).time;
        this.paint(byId("curves"), curves, byId("trait").value, now,
            (sequence) => this.chosen(timeline.slots.sequence.indexOf(sequence)));
    }
}
