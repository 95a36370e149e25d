// Every slot of a board, taken or missed, as a strip of thumbnails. Only those in sight are elements of the page: a season has
// ten thousand slots.
import { clockOf, dayOf, element, timeOf } from "./format.js";

const kWidth = 112; // px, of one slot; style.css has it too
const kSpare = 3;   // slots beyond each end of what is in sight

const kStates = { d: "done", m: "missed", a: "missed", p: "pruned", q: "quarantine", l: "lost" };

export class Timeline {
    /// `chosen(index)`: a person wants to see this slot.
    constructor(list, range, chosen) {
        Object.assign(this, { list, range, chosen, slots: null, current: -1, shown: new Map() });
        this.inner = element("div", "strip");
        list.append(this.inner);
        list.addEventListener("scroll", () => this.fill(), { passive: true });
        new ResizeObserver(() => this.fill()).observe(list);
        range.addEventListener("input", () => this.select(Number(range.value)));
        range.addEventListener("change", () => chosen(Number(range.value)));
    }

    /// `slots`: data/BOARD/slots.json.
    show(board, slots) {
        Object.assign(this, { board, slots, current: -1 });
        this.inner.replaceChildren();
        this.shown.clear();
        this.inner.style.width = `${this.count * kWidth}px`;
        this.range.max = Math.max(this.count - 1, 0);
        this.fill();
    }

    get count() {
        return this.slots ? this.slots.sequence.length : 0;
    }

    slot(index) {
        const { sequence, time_s: time, state, reason, reasons } = this.slots;
        return {
            sequence: sequence[index], time: time[index], state: kStates[state[index]], here: "dm".includes(state[index]),
            reason: reason[index] < 0 ? "" : reasons[reason[index]],
        };
    }

    /// Where the day after (1) or before (-1) that of the current slot begins.
    otherDay(direction) {
        let index = this.current;
        const day = dayOf(this.slot(index).time);
        while (index + direction >= 0 && index + direction < this.count && dayOf(this.slot(index).time) === day)
            index += direction;
        return index;
    }

    select(index) {
        this.shown.get(this.current)?.setAttribute("aria-selected", "false");
        this.current = index;
        this.range.value = index;
        const { sequence, time } = this.slot(index);
        this.range.setAttribute("aria-valuetext", `${sequence}, ${timeOf(time)}`);
        const { scrollLeft: left, clientWidth: width } = this.list;
        if (index * kWidth < left || (index + 1) * kWidth > left + width)
            this.list.scrollLeft = (index + 0.5) * kWidth - width / 2;
        this.fill();
        this.shown.get(index)?.setAttribute("aria-selected", "true");
        this.list.setAttribute("aria-activedescendant", `slot${index}`);
    }

    fill() {
        if (!this.slots)
            return;
        const first = Math.max(0, Math.floor(this.list.scrollLeft / kWidth) - kSpare);
        const end = Math.min(this.count, Math.ceil((this.list.scrollLeft + this.list.clientWidth) / kWidth) + kSpare);
        for (const [index, item] of this.shown)
            if (index < first || index >= end) {
                item.remove();
                this.shown.delete(index);
            }
        for (let index = first; index < end; ++index)
            if (!this.shown.has(index))
                this.shown.set(index, this.inner.appendChild(this.item(index)));
    }

    item(index) {
        const { sequence, time, state, here, reason } = this.slot(index);
        const item = element("div", `slot ${state}`);
        item.id = `slot${index}`;
        item.setAttribute("role", "option");
        item.setAttribute("aria-selected", String(index === this.current));
        item.setAttribute("aria-setsize", String(this.count));
        item.setAttribute("aria-posinset", String(index + 1));
        const words = state === "done" ? "" : `, ${state}${reason ? `: ${reason}` : ""}`;
        item.setAttribute("aria-label", `${sequence}, ${timeOf(time)}${words}`);
        item.title = `${sequence}, ${timeOf(time)}${words}`;
        item.style.left = `${index * kWidth}px`;
        if (state === "done") {
            const thumb = element("img");
            thumb.alt = "";
            thumb.loading = "lazy";
            thumb.onerror = () => thumb.replaceWith(element("p", "none", "no picture"));
            thumb.src = `data/${this.board}/${sequence}/thumb.jpg`;
            item.append(thumb);
        } else {
            item.append(element("p", "none", state, element("small", "", here ? reason : "")));
        }
        const newDay = index === 0 || dayOf(this.slot(index - 1).time) !== dayOf(time);
        item.append(element("span", "when", newDay ? element("b", "", dayOf(time).slice(5)) : "", time === null ? "no date" : ` ${clockOf(time)}`));
        item.addEventListener("click", () => this.chosen(index));
        return item;
    }
}
