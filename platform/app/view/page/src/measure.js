// The distance between two points of the cloud.
import { element, mm } from "./format.js";

const kStepPx = 2;
const kLargeStepPx = 20;

export class Measure {
    /// `scene`: a CloudScene; `marks`: the layer over it; `said(text)`: the readout; `axesWords()`: names of x, y, z.
    constructor(scene, marks, said) {
        Object.assign(this, { scene, marks, said, on: false, points: [], cross: null });
    }

    turnOn(on) {
        this.on = on;
        this.points = [];
        this.cross = null;
        this.said(on ? "Measuring: click or tap the first point, or move the cross with the arrow keys and press Enter." : "");
        this.draw();
    }

    /// A point of the cloud; -1: there is none where it was looked for.
    take(i) {
        if (i < 0) {
            this.said("There is no point: the cloud has a hole here.");
            return;
        }
        if (this.points.length === 2)
            this.points = [];
        this.points.push(i);
        this.said(this.points.length === 1 ? "First point set. Now the second one." : this.result());
        this.draw();
    }

    result() {
        const [one, other] = this.points.map((i) => this.scene.at(i));
        const d = other.clone().sub(one);
        return `${mm(one.distanceTo(other))} (right ${mm(d.x)}, away ${mm(d.y)}, up ${mm(d.z)})`;
    }

    /// Whether the key was for it.
    key(event) {
        const step = event.shiftKey ? kLargeStepPx : kStepPx;
        const moves = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] };
        const { clientWidth: width, clientHeight: height } = this.scene.canvas;
        if (event.key in moves) {
            const [dx, dy] = moves[event.key];
            this.cross ??= { x: width / 2, y: height / 2 };
            this.cross = { x: Math.min(Math.max(this.cross.x + dx, 0), width), y: Math.min(Math.max(this.cross.y + dy, 0), height) };
            this.draw();
        } else if (event.key === "Enter") {
            this.cross ??= { x: width / 2, y: height / 2 };
            this.take(this.scene.pick(this.cross.x, this.cross.y));
        } else {
            return false;
        }
        return true;
    }

    /// After each drawing of the scene.
    draw() {
        const marks = [];
        if (this.cross)
            marks.push(place(element("div", "cross"), this.cross));
        const ends = this.points.map((i) => this.scene.project(this.scene.at(i))).filter((end) => end !== null);
        for (const end of ends)
            marks.push(place(element("div", "end"), end));
        if (ends.length === 2) {
            const [one, other] = ends;
            const line = place(element("div", "line"), one);
            line.style.width = `${Math.hypot(other.x - one.x, other.y - one.y)}px`;
            line.style.transform = `rotate(${Math.atan2(other.y - one.y, other.x - one.x)}rad)`;
            const label = element("div", "label", this.result().split(" (")[0]);
            marks.push(line, place(label, { x: (one.x + other.x) / 2, y: (one.y + other.y) / 2 }));
        }
        this.marks.replaceChildren(...marks);
    }
}

function place(mark, { x, y }) {
    mark.style.left = `${x}px`;
    mark.style.top = `${y}px`;
    return mark;
}
