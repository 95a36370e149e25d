// The rectified picture and the disparities beside the cloud; a place in one is shown in all.
export class Pictures {
    /// `chosen(point)`: a person clicked where this point was seen.
    constructor(figures, chosen) {
        this.figures = figures;
        this.grid = null;
        for (const figure of figures) {
            const image = figure.querySelector("img");
            image.onerror = () => figure.classList.add("missing");
            image.onload = () => figure.classList.remove("missing");
            image.addEventListener("pointermove", (event) => this.mark(this.pointAt(image, event)));
            image.addEventListener("pointerleave", () => this.mark(-1));
            image.addEventListener("click", (event) => chosen(this.pointAt(image, event)));
        }
    }

    /// Before a snapshot is shown.
    clear() {
        this.grid = this.index = this.cloud = null;
        this.mark(-1);
        for (const figure of this.figures) {
            figure.querySelector("img").removeAttribute("src");
            figure.classList.remove("missing");
        }
    }

    show(i, path) {
        this.figures[i].querySelector("img").src = path;
    }

    /// Which pixel saw which point. `grid`: width, height, focal_px, cx_px, cy_px.
    link(grid, cloud) {
        Object.assign(this, { grid, cloud, index: new Int32Array(grid.width * grid.height).fill(-1) });
        for (let i = 0; i < cloud.count; ++i) {
            const { column, row } = this.pixelOf(i);
            if (column >= 0 && row >= 0 && column < grid.width && row < grid.height)
                this.index[row * grid.width + column] = i;
        }
    }

    pixelOf(i) {
        const { focal_px: focal, cx_px: cx, cy_px: cy } = this.grid;
        const [x, y, z] = this.cloud.position.subarray(3 * i, 3 * i + 3);
        return { column: Math.round(focal * x / z + cx), row: Math.round(focal * y / z + cy) };
    }

    /// -1: no point.
    pointAt(image, event) {
        if (!this.grid)
            return -1;
        const box = image.getBoundingClientRect();
        const column = Math.floor((event.clientX - box.left) / box.width * this.grid.width);
        const row = Math.floor((event.clientY - box.top) / box.height * this.grid.height);
        return this.index[row * this.grid.width + column] ?? -1;
    }

    mark(i) {
        const pixel = i >= 0 && this.grid ? this.pixelOf(i) : null;
        for (const figure of this.figures) {
            const mark = figure.querySelector("i");
            mark.hidden = pixel === null;
            if (pixel) {
                mark.style.left = `${(pixel.column + 0.5) / this.grid.width * 100}%`;
                mark.style.top = `${(pixel.row + 0.5) / this.grid.height * 100}%`;
            }
        }
    }
}
